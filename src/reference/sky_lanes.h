// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A picture of the sky, made ready for sixteen directions at once (sky_lanes_simd.cpp); EnvironmentSampler owns it.
#pragma once

#include <vector>

#include "reference/lanes.h"

namespace gloam::reference {

struct SkyTable {
  int width = 0, height = 0;  ///< texels
  /// Cell (x, y) lies between four texels, w: importance. [cell][upper left, lower left], row by row, of width + 1 cells each: the
  /// next entry has the two on the right. So a cell comes from memory in one piece, or two.
  std::vector<glm::vec4> texels;
  float cos_rotation = 1.0f, sin_rotation = 0.0f;
  float turned = 0.5f;        ///< longitude 0 in the picture, as a share of its width
  float polar_height = 0.0f;  ///< of the caps above and below the outermost texel centres
  std::vector<float>
      density;  ///< of each row of cells; times importance (/ cos elevation, but at the poles): the density
  /// Inverse of the cumulative distribution of rows, and of the cells in each of them (Distribution's, one after another,
  /// starts closed by the largest number, first by the
  /// last entry, and by one more at the end).
  std::vector<std::uint32_t> row_starts, cell_starts;
  std::vector<std::uint16_t> row_first, cell_first;
  int row_shift = 0, cell_shift = 0;
};

/// Where directions lie: a cell and a place in it.
struct SkyPlaces {
  LaneInts cell_x, cell_y;
  LaneFloats x, y;
  LaneFloats cos_elevation;  ///< unknown as long as it comes from chooseCells
};
struct SkyLight {
  LaneVectors radiance;
  LaneFloats pdf;  ///< 1/sr
};

/// Cells by their light, from numbers as Sampler::numbers gives them; x and y are what is left of those.
void chooseCells(const SkyTable& sky, const Sampler::Scramble& scramble, const LaneBits& places,
                 SkyPlaces& cells);
/// Places within chosen cells with the bilinear density, and the directions to them.
void placeInCells(const SkyTable& sky, SkyPlaces& places, LaneVectors& directions);
void placesOf(const SkyTable& sky, const LaneVectors& directions, SkyPlaces& places);
/// Sends for the light of those lanes (a bit each): lightAt is better called some time later.
void sendFor(const SkyTable& sky, const SkyPlaces& places, std::uint32_t mask);
/// Of those lanes; 0 in all others.
void lightAt(const SkyTable& sky, const SkyPlaces& places, std::uint32_t mask, SkyLight& light);

}  // namespace gloam::reference
