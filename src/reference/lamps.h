// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Punctual lights for paths, as frame_local_light.comp.glsl has them.
#pragma once

#include <gloam/scene.h>

#include <vector>

namespace gloam::reference {

struct Lamp {
  Light::Type type = Light::Type::kPoint;
  glm::vec3 position{0.0f}, direction{0.0f, 0.0f, -1.0f}, intensity{0.0f};
  float range = 0.0f, cos_inner = 1.0f, cos_outer = 0.0f;

  /// Irradiance on a plane that faces the lamp, without shadow.
  struct Arriving {
    glm::vec3 irradiance{0.0f};
    glm::vec3 to_lamp{0.0f};  ///< unit
    float distance = 0.0f;    ///< infinite for directional lights
  };
  Arriving at(const glm::vec3& position) const;
};

/// Those that shine. Throws Error for numbers that are not finite.
std::vector<Lamp> makeLamps(const PosedScene& posed);

}  // namespace gloam::reference
