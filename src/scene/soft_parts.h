// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Distances of which bodies are moulded: capsules whose radius changes along them, melted into each other.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace gloam {

/// A capsule from a to b whose radius changes along it.
struct TaperedCapsule {
  glm::vec3 a, b;
  float radius_a, radius_b;
};

/// Nearly the distance from its surface, negative inside.
inline float distanceTo(const TaperedCapsule& part, const glm::vec3& p) {
  const glm::vec3 ab = part.b - part.a;
  const float t = std::clamp(glm::dot(p - part.a, ab) / glm::dot(ab, ab), 0.0f, 1.0f);
  return glm::length(p - part.a - t * ab) - glm::mix(part.radius_a, part.radius_b, t);
}

/// The lesser of two distances, rounded where they differ by less than `reach`.
inline float smoothMinimum(float a, float b, float reach) {
  const float h = std::max(0.0f, reach - std::abs(a - b)) / reach;
  return std::min(a, b) - 0.25f * h * h * reach;
}

}  // namespace gloam
