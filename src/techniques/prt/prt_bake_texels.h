// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Texels of lightmaps as points of a bake (PRT-3): where each lies on its mesh, which meshes have any.
#pragma once

#include <gloam/bake.h>

#include "techniques/prt/prt_bake_points.h"

namespace gloam::prt {

inline constexpr int kLeastTexels = 4, kMostTexels = 4096;  ///< a side

struct LightmapSize {
  int width = 0, height = 0, uv_set = 0;  ///< width 0: there is none
};

/// By instance. Warns of meshes that keep vertices, and says why; throws Error where texels are too many to count. Empty where
/// the options ask for no texels.
std::vector<LightmapSize> chooseLightmaps(const Scene& scene, const PosedScene& posed,
                                          const BakeOptions& options, Warnings& warnings);

inline bool wantsTexels(const BakeOptions& options) {
  return options.texels > 0 || options.texels_per_metre > 0.0f;
}
/// Texels of all lightmaps that triangles cover. Throws as requireLightmaps.
std::size_t countTexels(const Scene& scene, const PosedScene& posed, const BakeOptions& options);
/// Throws Error where texels are asked for and no mesh of the whole scene can have any.
void requireLightmaps(const Scene& scene, const PosedScene& posed, const BakeOptions& options);

/// Why texture coordinates of a mesh cannot be those of a lightmap, or nothing.
std::string unfitForLightmap(const Mesh& mesh, int uv_set);

/// Where a texel lies on a mesh: the point of its triangles nearest to its middle in texture coordinates.
struct CoveredTexel {
  static constexpr std::uint32_t kNoTriangle = ~0u;
  std::uint32_t triangle = kNoTriangle;  ///< none within half a texel's diagonal of its middle
  glm::vec2 share{0.0f};                 ///< barycentric
};
/// Texels y * width + x. Conservative: a texel that a triangle merely touches has the point where that is nearest.
std::vector<CoveredTexel> coveredTexels(const Mesh& mesh, const LightmapSize& size);

/// Adds points for covered texels of all lightmaps.
void addTexels(BakePoints& points, const Scene& scene, const PosedScene& posed,
               const std::vector<LightmapSize>& sizes);

/// visit(point) for each of the eight texels around one that lie beside it on the surface, too.
template <class Visit>
void forTexelsAround(const BakePoints& points, std::size_t point, const Visit& visit);

/// Three texels around a place of a mesh, and their shares: linear over the halves of a cell of four.
struct TexelCorners {
  glm::uvec3 point{0u};
  glm::vec3 share{0.0f};
};
TexelCorners texelsAt(const TexelMap& map, const Mesh& mesh, int triangle, float u, float v);

// ---- forTexelsAround
std::uint32_t texelBeside(const BakePoints& points, std::size_t point, int dx, int dy);

template <class Visit>
void forTexelsAround(const BakePoints& points, std::size_t point, const Visit& visit) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const std::uint32_t q = texelBeside(points, point, dx, dy);
      if (q != BakePoints::kNoPoint) visit(q);
    }
  }
}

}  // namespace gloam::prt
