// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What tests of the bake measure. "Brightness" is what a vertex of albedo 1 sends back under uniform light of radiance 1:
// M . (sqrt(4 pi), 0, 0 ...) / pi.
#pragma once

#include <gloam/scene.h>

#include <cmath>

#include "math/sampling.h"

namespace gloam::prt {

inline std::size_t coefficients(const Transfer& t) {
  return std::size_t(t.order * t.order);
}

inline float directBrightness(const Mesh& mesh, std::size_t vertex) {
  return mesh.transfer->direct[vertex * coefficients(*mesh.transfer)] * std::sqrt(4.0f * sampling::kPi) /
         sampling::kPi;
}
inline glm::vec3 indirectBrightness(const Mesh& mesh, std::size_t vertex) {
  const float* m = &mesh.transfer->indirect[vertex * 3 * coefficients(*mesh.transfer)];
  return glm::vec3(m[0], m[1], m[2]) * (std::sqrt(4.0f * sampling::kPi) / sampling::kPi);
}
inline float brightness(const Mesh& mesh, std::size_t vertex) {
  return directBrightness(mesh, vertex) + indirectBrightness(mesh, vertex).g;
}

}  // namespace gloam::prt
