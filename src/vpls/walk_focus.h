// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Where light from far away should enter a wide scene: about what the camera sees.
#pragma once

#include <span>
#include <vector>

#include "visibility/visibility_shared.h"

namespace gloam::vpls {

/// A density over planes across any direction: the mean of round hills above points that are seen, as wide as points stand apart.
class Focus {
 public:
  Focus() = default;
  /// Hills are at least `least_radius` metres wide.
  Focus(std::span<const visibility::SightPoint> seen, float least_radius);
  bool empty() const { return hills_.empty(); }
  /// Of what enters through `area` (square metres across its way), the share that should go by the density: none where the whole area is
  /// about what is seen.
  float share(float area) const;
  /// A place on a line along `direction` (unit) that was chosen by the density.
  glm::vec3 point(const glm::vec2& u, const glm::vec3& direction) const;
  /// Per square metre across `direction`, of the line through a place.
  float density(const glm::vec3& place, const glm::vec3& direction) const;

 private:
  struct Hill {
    glm::vec3 top;
    float radius;
  };
  std::vector<Hill> hills_;
  float mean_density_ = 0.0f;  // where the points are
};

}  // namespace gloam::vpls
