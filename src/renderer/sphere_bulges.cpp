// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/sphere_bulges.h"

#include <algorithm>

#include "renderer/set_surface.h"

namespace gloam {

namespace {

constexpr std::size_t kPointsASphere = 256, kFewestPoints = 2048;

float median(std::vector<float>& values) {
  if (values.empty()) return 0.0f;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<float> sphereBulges(const Scene& scene, const SphereSet& set, const std::vector<float>& shares) {
  if (set.spheres.empty()) return {};
  std::vector<std::vector<float>> within(set.spheres.size());
  const float outward = facing(scene, set);
  const std::size_t count = std::max(kFewestPoints, kPointsASphere * set.spheres.size());
  for (const AreaPoint& at : pointsByArea(scene, set, count)) {
    const glm::vec3 place = placeOf(scene, set, at), normal = outward * normalOf(scene, set, at);
    for (std::size_t s = 0; s < set.spheres.size(); ++s) {
      const glm::vec3 to = set.spheres[s].center - place;
      const float radius = shares[s] * set.spheres[s].radius;
      if (glm::dot(to, to) > radius * radius) continue;
      within[s].push_back(std::clamp(0.5f + 0.5f * glm::dot(to, normal) / radius, 0.0f, 1.0f));
    }
  }
  std::vector<float> bulges;
  for (std::vector<float>& values : within) bulges.push_back(median(values));
  return bulges;
}

}  // namespace gloam
