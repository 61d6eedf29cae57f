// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
#include "techniques/splatting/splatting_lamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gloam::splatting {

void tellLamps(const frame::FrameInputs& inputs) {
  const glm::vec3 low = inputs.scene.boundsMin(), high = inputs.scene.boundsMax();
  const glm::vec3 middle = 0.5f * (low + high);
  const float radius = 0.5f * glm::distance(low, high);
  for (std::size_t i = 0; i < inputs.shadow_maps.lights.size(); ++i) {
    const frame::LightRow& lamp = inputs.shadow_maps.lights[i];
    if (lamp.kind == frame::kLightDirectional) continue;
    const auto tell = [&](const char* what) {
      inputs.warnings.push_back(fmt::format("lamp {} sends no light into the scene: {}", i + 1, what));
    };
    const float distance = glm::distance(lamp.position, middle);
    const float nearest = glm::distance(lamp.position, glm::clamp(lamp.position, low, high));
    if (lamp.range > 0.0f && nearest >= lamp.range) {
      tell("its range ends before it");
    } else if (lamp.kind == frame::kLightSpot && lamp.cos_outer >= 1.0f - 1e-7f) {
      tell("its cone has no angle");
    } else if (lamp.kind == frame::kLightSpot && distance > radius) {
      const float off =
          std::acos(std::clamp(glm::dot(lamp.direction, middle - lamp.position) / distance, -1.0f, 1.0f));
      if (off > std::acos(std::clamp(lamp.cos_outer, -1.0f, 1.0f)) + std::asin(radius / distance))
        tell("it shines away from it");
    }
  }
}

}  // namespace gloam::splatting
