// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Turns about the axes, radians, counter-clockwise seen from the axis' tip.
#pragma once

#include <glm/gtc/quaternion.hpp>

namespace gloam {

inline glm::quat aboutX(float rad) {
  return glm::angleAxis(rad, glm::vec3(1, 0, 0));
}
inline glm::quat aboutY(float rad) {
  return glm::angleAxis(rad, glm::vec3(0, 1, 0));
}
inline glm::quat aboutZ(float rad) {
  return glm::angleAxis(rad, glm::vec3(0, 0, 1));
}

}  // namespace gloam
