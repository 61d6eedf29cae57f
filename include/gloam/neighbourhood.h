// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Neighbourhood transfer (Sloan, Kautz, Snyder 2002, section 7; PRT-6): a grid of transfer matrices round an object, by which
// it throws soft shadow, glossy reflection and caustics on whatever moves through.
#pragma once

#include <gloam/scene.h>

namespace gloam {

/// In the axes of the node that carries it. At point (x, y, z), x first, of a regular grid: from the light's coefficients (a
/// bands) to those of the radiance that arrives there (b bands). Visibility stands as in GlossyTransfer: V of (a + b - 1)
/// bands, of which the matrix is GS_ij = sum over k of Gamma_ijk V_k; here V has no tangent plane, it is that of free space.
struct NeighbourhoodTransfer {
  glm::vec3 first_point{0.0f}, spacing{1.0f};
  glm::ivec3 size{0};                    ///< points along each axis, 2 at least
  int light_order = 0, field_order = 0;  ///< a and b
  int bounces = 0;                       ///< contained in `indirect`
  std::vector<float> visibility;         ///< [point][coefficient]
  std::vector<float> indirect;           ///< [point][i][j][rgb], i < b^2, j < a^2; empty without bounces
  std::size_t points() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
};

}  // namespace gloam
