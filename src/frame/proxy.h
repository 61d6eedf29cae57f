// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace gloam::frame {

/// A sphere that stands for a part of a thing as it blocks light and sends it back, where it is in this frame.
struct Proxy {
  glm::vec3 center{0.0f};  ///< world, metres
  float radius = 0.0f;
  glm::vec3 albedo{0.5f};  ///< diffuse, linear, of the surface that it stands for
  float bulge = 0.0f;      ///< how much of its width stands out of that surface, 0 to 1
};

}  // namespace gloam::frame
