// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How large a sphere looks from a receiver that may lie in it or on its surface. With centre height h = (c - p) . N, top
// t = h + r and x the distance of the centre along the tangent plane: t <= 0 drops the sphere; h >= r leaves it, sin = r / d;
// else it acts as a sphere of radius rho = (h + r) / 2 that stands on the plane at the same foot point, with
//   sin = rho / sqrt(max(x^2, r^2 - h^2) + rho^2):
// held, within the sphere, at its value on crossing its surface. Of a sphere of which no more stands out of the plane than of the
// surface that it stands for (`bulge`), or little more, less counts than does: spheres that bound a wall, an ear or a limb bulge out of it
// by so much, and would darken it in spots. Continuous; a body that one sphere fits well does not darken itself. The rule is ours:
// Sloan et al. 2007 say "reduced or culled".
#pragma once

#include <glm/glm.hpp>

namespace gloam::spheres {

/// A sphere as the receiver takes it.
struct SeenSphere {
  float sin_half_angle;  ///< 0 where it is dropped
  glm::vec3 direction;   ///< unit, to the centre of the sphere that stands for it; N where that has none
};

/// Of a sphere's width: what may stand out of a plane and count nothing, at least; the most that a surface makes of it; how much more
/// stands out where all of it counts.
inline constexpr float kLeastBulge = 0.08f, kMostBulge = 0.5f, kFull = 0.32f;

/// bulge: how much of the sphere's width stands out of the surface that it stands for, 0 to 1.
inline SeenSphere seenSphere(const glm::vec3& receiver, const glm::vec3& normal, const glm::vec3& center,
                             float radius, float bulge = 0.0f) {
  const glm::vec3 d = center - receiver;
  const float height = glm::dot(d, normal);
  if (height + radius <= 0.0f || radius <= 0.0f) return {0.0f, normal};
  if (height >= radius) {
    const float distance = glm::length(d);
    return {glm::min(radius / distance, 1.0f), d / distance};
  }
  const float nothing = glm::clamp(bulge, kLeastBulge, kMostBulge);
  const float out = glm::smoothstep(nothing, nothing + kFull, 0.5f * (height + radius) / radius);
  const float standing = 0.5f * (height + radius) * out;
  if (!(standing > 0.0f)) return {0.0f, normal};
  const glm::vec3 along = d - height * normal;
  const float x2 = glm::dot(along, along);
  const float held2 = glm::max(x2, radius * radius - height * height);
  const glm::vec3 to_standing = along + standing * normal;
  const float length = glm::length(to_standing);
  return {standing / glm::sqrt(held2 + standing * standing), length > 0.0f ? to_standing / length : normal};
}

}  // namespace gloam::spheres
