// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Points of a surface, and whether balls hold it.
#pragma once

#include <functional>

#include "spheres/fit.h"

namespace gloam::spheres {

/// Points spread evenly over the area.
std::vector<glm::vec3> sampleSurface(const Soup& soup, int count, std::uint32_t seed);

inline bool holds(const Ball& ball, const glm::vec3& p) {
  const glm::vec3 d = p - ball.center;
  return glm::dot(d, d) <= ball.radius * ball.radius;
}
/// Share of these points that lie in at least one ball.
double coveredShare(const std::vector<glm::vec3>& points, const std::vector<Ball>& balls);

/// Points that no ball holds. Triangles whose corners lie in one ball are held; others are divided down to edges of
/// `finest`, and corners are tested. Of each cube of a few times that size, the point that lies farthest out.
/// Throws Interrupted when asked to stop.
std::vector<glm::vec3> uncoveredPoints(const Soup& soup, const std::vector<Ball>& balls, float finest,
                                       const std::function<bool()>& should_stop = {});

/// Makes the balls hold all of the surface, for certain: pieces with edges of `finest` that lie across several balls are
/// held by one of them after it has grown, the one that pays least for it.
void growOver(const Soup& soup, std::vector<Ball>& balls, float finest,
              const std::function<bool()>& should_stop = {});

}  // namespace gloam::spheres
