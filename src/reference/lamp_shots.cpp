// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference/lamp_shots.h"

#include <algorithm>

#include "math/sampling.h"

namespace gloam::reference {
namespace {

constexpr std::uint32_t kLooks = 1024;
// A lamp in the middle of a sphere that is seen has 1. Below this, steps by lobes find its light well enough by themselves.
constexpr float kLeastNearness = 25.0f;
constexpr float kNarrowest = 1e-5f;  // 1 - cosine; a beam lights a spot that is far away

/// Steps by lobes find places by their area, about evenly over as much as is seen: 4 pi r^2. The variance that they have is
/// that of irradiance E over it: the mean of E^2 over the square of the mean. A ray of the lamp lands on the area
/// d^2 / cos of its solid angle, which makes both means of the rays.
float nearness(const Lamp& lamp, const glm::mat3& world_from_cone, float cosine, const trace::Tracer& tracer,
               std::span<const glm::vec3> seen) {
  std::vector<float> squares;
  for (const glm::vec3& place : seen)
    squares.push_back(glm::dot(place - lamp.position, place - lamp.position));
  const auto middle = squares.begin() + std::ptrdiff_t(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  double sum = 0.0;
  for (std::uint32_t i = 0; i < kLooks; ++i) {
    const glm::vec3 direction = world_from_cone * sampling::uniformCone(sampling::r2(i), cosine);
    const trace::Hit hit = tracer.closest({lamp.position, direction});
    if (!hit) continue;
    const float squared = std::max(hit.distance * hit.distance, punctual::kLeastSquaredDistance);
    sum += double(std::abs(glm::dot(hit.geometric_normal, direction)) / squared);
  }
  return float(sum / kLooks) * *middle * (2.0f / (1.0f - cosine));
}

}  // namespace

LampShots::LampShots(std::vector<Lamp>& lamps, const trace::Tracer& tracer, std::span<const glm::vec3> seen) {
  if (seen.empty()) return;
  std::vector<float> power(lamps.size(), 0.0f);
  cones_.resize(lamps.size());
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    const Lamp& lamp = lamps[i];
    Cone& cone = cones_[i];
    if (lamp.type == Light::Type::kSpot) cone = {sampling::frame(lamp.direction), lamp.cos_outer};
    if (lamp.type == Light::Type::kDirectional || 1.0f - cone.cosine < kNarrowest) continue;
    if (nearness(lamp, cone.world_from_cone, cone.cosine, tracer, seen) < kLeastNearness) continue;
    power[i] = (lamp.intensity.r + lamp.intensity.g + lamp.intensity.b) * (1.0f - cone.cosine);
  }
  choice_ = Distribution(power);
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    if (power[i] > 0.0f && !choice_.empty())
      lamps[i].shot_density =
          choice_.probability(std::uint32_t(i)) / (2.0f * sampling::kPi * (1.0f - cones_[i].cosine));
  }
}

LampShots::Shot LampShots::shoot(std::uint32_t number, const glm::vec2& u) const {
  const std::uint32_t lamp = choice_.choose(number).index;
  const Cone& cone = cones_[lamp];
  return {int(lamp), cone.world_from_cone * sampling::uniformCone(u, cone.cosine)};
}

}  // namespace gloam::reference
