// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Smoke and cloud: density on a grid, and its transfer (Sloan, Kautz, Snyder 2002, section 6; PRT-7).
#pragma once

#include <gloam/scene.h>

namespace gloam {

/// Density in a box that stands in the axes of the node that carries it. Voxel (x, y, z), x first, is centred at
/// bounds_min + (x + 1/2, …) * (bounds_max - bounds_min) / size; between centres it is trilinear, outside the box nothing.
struct Volume {
  std::string name;
  glm::ivec3 size{0};
  glm::vec3 bounds_min{0.0f}, bounds_max{1.0f};
  std::vector<float> density;                ///< extinction, 1 / metre, not negative
  glm::vec3 albedo{0.99f};                   ///< share of extinction that scatters
  float asymmetry = 0.0f;                    ///< g of the Henyey-Greenstein phase function, -1 < g < 1
  std::shared_ptr<const Transfer> transfer;  ///< of the voxels, as points; null unless baked
  std::size_t voxels() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
};

}  // namespace gloam
