// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Punctual lights for paths, as frame_local_light.comp.glsl has them.
#pragma once

#include <gloam/scene.h>

#include <cmath>
#include <limits>
#include <vector>

#include "math/punctual.h"

namespace gloam::reference {

struct Lamp {
  Light::Type type = Light::Type::kPoint;
  glm::vec3 position{0.0f}, direction{0.0f, 0.0f, -1.0f}, intensity{0.0f};
  float range = 0.0f, cos_inner = 1.0f, cos_outer = 0.0f;
  float shot_density = 0.0f;  ///< 1/sr: LampShots; 0 where it sends no rays

  /// Irradiance on a plane that faces the lamp, without shadow.
  struct Arriving {
    glm::vec3 irradiance{0.0f};
    glm::vec3 to_lamp{0.0f};  ///< unit
    float distance = 0.0f;    ///< infinite for directional lights
  };
  Arriving at(const glm::vec3& position) const;
};

inline Lamp::Arriving Lamp::at(const glm::vec3& place) const {
  if (type == Light::Type::kDirectional)
    return {intensity, -direction, std::numeric_limits<float>::infinity()};
  const glm::vec3 between = position - place;
  const float squared = std::max(glm::dot(between, between), punctual::kLeastSquaredDistance);
  const float distance = std::sqrt(squared);
  const glm::vec3 to_lamp = between * (1.0f / distance);
  float factor = punctual::rangeFactor(distance, range) / squared;
  if (type == Light::Type::kSpot)
    factor *= punctual::coneFactor(-glm::dot(to_lamp, direction), cos_inner, cos_outer);
  return {intensity * factor, to_lamp, distance};
}

/// Those that shine. Throws Error for numbers that are not finite.
std::vector<Lamp> makeLamps(const PosedScene& posed);

}  // namespace gloam::reference
