// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A hill is 2 / (pi R^2) (1 - r^2 / R^2): no light jumps as hills glide with the camera.
#include "vpls/walk_focus.h"

#include <algorithm>
#include <numbers>

#include "math/sampling.h"

namespace gloam::vpls {

namespace {

constexpr std::size_t kNeighbours = 4;
constexpr float kMost = 0.5f;
constexpr float kWorth = 1.5f;  // so many times denser than without: all of it

}  // namespace

Focus::Focus(std::span<const visibility::SightPoint> seen, float least_radius) {
  std::vector<float> squared(seen.size());
  for (const visibility::SightPoint& point : seen) {
    std::ranges::transform(seen, squared.begin(), [&](const visibility::SightPoint& other) {
      const glm::vec3 between = other.position - point.position;
      return glm::dot(between, between);
    });
    const auto nth = squared.begin() + std::ptrdiff_t(std::min(kNeighbours, squared.size() - 1));
    std::nth_element(squared.begin(), nth, squared.end());
    const float radius = std::max(std::sqrt(*nth), least_radius);
    if (radius > 0.0f && std::isfinite(radius)) hills_.push_back({point.position, radius});
  }
  for (const Hill& hill : hills_) mean_density_ += density(hill.top, glm::vec3(0.0f)) / float(hills_.size());
}

float Focus::share(float area) const {
  return kMost * std::clamp((mean_density_ * area - 1.0f) / (kWorth - 1.0f), 0.0f, 1.0f);
}

glm::vec3 Focus::point(const glm::vec2& u, const glm::vec3& direction) const {
  const float at = u.x * float(hills_.size());
  const Hill& hill = hills_[std::min(std::size_t(at), hills_.size() - 1)];
  const float r = hill.radius * std::sqrt(1.0f - std::sqrt(std::max(0.0f, 1.0f - (at - std::floor(at)))));
  const float angle = 2.0f * std::numbers::pi_v<float> * u.y;
  return hill.top + sampling::frame(direction) * glm::vec3(r * std::cos(angle), r * std::sin(angle), 0.0f);
}

float Focus::density(const glm::vec3& place, const glm::vec3& direction) const {
  float sum = 0.0f;
  for (const Hill& hill : hills_) {
    const glm::vec3 between = place - hill.top, across = between - glm::dot(between, direction) * direction;
    const float squared_radius = hill.radius * hill.radius;
    sum += std::max(0.0f, 1.0f - glm::dot(across, across) / squared_radius) / squared_radius;
  }
  return 2.0f * sum / (std::numbers::pi_v<float> * float(hills_.size()));
}

}  // namespace gloam::vpls
