// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference/lamps.h"

#include <cmath>

namespace gloam::reference {
namespace {

bool isFinite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

std::vector<Lamp> makeLamps(const PosedScene& posed) {
  std::vector<Lamp> lamps;
  for (const PosedLight& given : posed.lights) {
    const Light& light = given.light;
    if (!isFinite(given.position) || !isFinite(given.direction) || !isFinite(light.intensity) ||
        !std::isfinite(light.range) || !std::isfinite(light.outer_cone_rad) ||
        !std::isfinite(light.inner_cone_rad))
      throw Error("light '" + light.name + "'",
                  "position, direction, intensity, range and cones must be finite numbers");
    if (light.intensity == glm::vec3(0.0f)) continue;
    lamps.push_back({light.type, given.position, given.direction, light.intensity, light.range,
                     std::cos(light.inner_cone_rad), std::cos(light.outer_cone_rad)});
  }
  return lamps;
}

}  // namespace gloam::reference
