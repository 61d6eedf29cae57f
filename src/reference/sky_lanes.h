// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A picture of the sky, made ready for sixteen directions at once (sky_lanes_simd.cpp); EnvironmentSampler owns it.
#pragma once

#include <span>
#include <vector>

#include "reference/lanes.h"

namespace gloam::reference {

/// A part of the picture, in cells. Directions have a bilinear density in it: one cell's follows its light, so that the few
/// texels of a sun get their share of evenly spread samples as it is; larger ones' the cosine of the elevation alone, so
/// nearly evenly in solid angle.
struct SkyBlock {
  float x = 0.0f, y = 0.0f, across = 0.0f, down = 0.0f;
  /// Upper left, upper right, lower left, lower right; / cos elevation: 1/sr.
  float densities[4] = {};
};

/// Radiance in eight bytes: 18 bits a colour and the power of two that they share, to 4e-6 of the largest of them.
struct SkyTexel {
  std::uint32_t low = 0,
                high = 0;  ///< red, 14 bits of green; 4 bits of green, blue, exponent as floats have it
};
SkyTexel packed(const glm::vec3& radiance);
glm::vec3 unpacked(const SkyTexel& texel);

struct SkyTable {
  int width = 0, height = 0;  ///< texels
  /// Cell (x, y), y up to `height`, lies between four texels. [cell][upper left, lower left], row by row, of width + 1 cells
  /// each: the next entry has the two on the right. So a cell comes from memory in one piece, or two.
  std::vector<SkyTexel> texels;
  float cos_rotation = 1.0f, sin_rotation = 0.0f;
  float turned = 0.5f;  ///< longitude 0 in the picture, as a share of its width
  /// Row of tiles by row of tiles, in each from left to right. Few enough for a processor's second cache.
  std::vector<SkyBlock> blocks;
  /// Inverses of the cumulative distributions of rows, and of the blocks in each of them, one after another (Distribution's;
  /// each one's starts closed by the largest number, its first by the last entry, and all by one more).
  std::vector<std::uint32_t> row_starts, block_starts;
  std::vector<std::uint16_t> row_first, block_first;
  int row_shift = 0, block_shift = 0;
  std::vector<std::int32_t> row_blocks;  ///< first block of each row
  /// The block at a place: a quadtree under each tile of 2^tile_bits cells each way. An entry is a block, or ~ the first of
  /// four entries of `nodes`: upper left, upper right, lower left, lower right.
  int tile_bits = 0, tiles_across = 0;
  std::vector<std::int32_t> tiles, nodes;
};

/// Cuts the sky into blocks, finer where it is less even, out of the importance of its texels (width + 1 by height + 2, with
/// a border as the cells need it), and fills all that chooses and finds them; nothing where there is no light
/// (sky_blocks.cpp).
void fillBlocks(SkyTable& sky, std::span<const float> importance);

/// Where directions lie: a cell and a place in it.
struct SkyPlaces {
  LaneInts cell_x, cell_y;
  LaneFloats x, y;
  LaneFloats density, cos_elevation;  ///< the one by the other is 1/sr
};
/// Directions by their light, from numbers as Sampler::numbers gives them.
void chooseIn(const SkyTable& sky, const Sampler::Scramble& scramble, const LaneBits& numbers,
              SkyPlaces& places, LaneVectors& directions);
void placesOf(const SkyTable& sky, const LaneVectors& directions, SkyPlaces& places);
/// 1/sr.
void densitiesOf(const SkyPlaces& places, LaneFloats& pdf);
/// Sends for the light of a lane: radianceOf is better asked some time later.
inline void sendFor(const SkyTable& sky, const SkyPlaces& places, int lane) {
  const SkyTexel* texel = &sky.texels[2 * (std::size_t(places.cell_y.at[lane]) * std::size_t(sky.width + 1) +
                                           std::size_t(places.cell_x.at[lane]))];
  __builtin_prefetch(texel);
  __builtin_prefetch(texel + 3);
}
/// Of those lanes (a bit each); 0 in all others.
void radianceOf(const SkyTable& sky, const SkyPlaces& places, std::uint32_t mask, LaneVectors& radiance);

}  // namespace gloam::reference
