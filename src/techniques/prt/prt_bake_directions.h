// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The directions of a bake with everything that is the same at every point: basis functions, cones, the order in
// which they are traced.
#pragma once

#include <hwy/aligned_allocator.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace gloam::prt {

inline constexpr int kTileSize = 16;  ///< directions of a tile: the lanes of a ray packet

/// The tables of one batch as plain pointers, for vectorised code.
struct TableView {
  const float* directions;  ///< [tile][xyz][16]
  const float* basis;       ///< [tile][coefficient][16]
  const float* cones;       ///< [x, y, z of the axis, sine of the half-angle][tile]
  std::size_t cone_stride;
  std::size_t tiles, coefficients;
};

/// Directions that are traced together: all of them, or, where a point stops as soon as it is known well enough, one of the
/// sets that double what came before.
struct DirectionBatch {
  int first = 0, end = 0;                        ///< tiles
  std::size_t first_cone = 0;                    ///< into each row of the cones
  std::size_t first_bounce = 0, end_bounce = 0;  ///< into DirectionTables::bounce_tile
};

/// The tiles of a batch stand in the order in which they are traced: along a curve over the sphere, so that one packet meets
/// the part of the hierarchy that the packet before it has warmed (5 % faster than scattered ones).
struct DirectionTables {
  int order = 0;
  int coefficients = 0;
  int tiles = 0;         ///< all of the first pass
  int bounce_tiles = 0;  ///< of these, the ones that bounce passes use: an even subset
  std::vector<DirectionBatch> batches;
  hwy::AlignedFreeUniquePtr<float[]> directions, basis, cones;  ///< as TableView tells
  std::size_t cone_stride = 0;                                  ///< tiles, each batch rounded up to 16
  std::vector<std::int32_t> bounce_tile;                        ///< indices into the tiles above, ascending

  TableView view(const DirectionBatch& batch) const {
    return {tileDirections(batch.first),
            basis.get() + std::size_t(batch.first) * std::size_t(coefficients) * kTileSize,
            cones.get() + batch.first_cone,
            cone_stride,
            std::size_t(batch.end - batch.first),
            std::size_t(coefficients)};
  }
  const float* tileDirections(int tile) const { return directions.get() + std::size_t(tile) * 3 * kTileSize; }
  glm::vec3 direction(int tile, int lane) const {
    const float* d = tileDirections(tile) + lane;
    return {d[0], d[kTileSize], d[2 * kTileSize]};
  }
  float solidAngle() const { return solidAngle(std::size_t(tiles)); }
  static float solidAngle(std::size_t tile_count);  ///< of a direction, where that many tiles are used
  std::size_t memoryBytes() const;
};

/// `count` and `bounce_count` are rounded to whole tiles; the subset is the even prefix that is nearest in size to
/// what is asked for, so it may be up to 1.5 times larger or smaller. In steps, batches double the tiles from about
/// kFirstStep directions on.
inline constexpr int kFirstStep = 512;
/// With fewer there is one step, and nothing to hold it against.
inline constexpr int kLeastDirectionsOfError = 2 * (kFirstStep * 3 / 4);
DirectionTables makeDirectionTables(int order, int count, int bounce_count, bool in_steps = false);

}  // namespace gloam::prt
