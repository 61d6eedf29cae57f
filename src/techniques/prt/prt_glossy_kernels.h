// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The inner loops of a glossy bake (PRT-2), vectorised for whatever the machine has, as prt_bake_kernels.h.
#pragma once

#include <cstddef>
#include <cstdint>

namespace gloam::prt {

/// Adds up the basis functions of the blocked directions: blocked[tile] as traceBlocked leaves it, `basis` and `tile_sums`
/// as GlossyTables has them, `stride` (a multiple of 16, at most 128) values in each row. A tile takes as many additions as
/// it has directions of the rarer sort, or one where all are blocked.
void sumBlocked(const float* basis, const float* tile_sums, std::size_t stride, const std::uint16_t* blocked,
                std::size_t tiles, float* sums);

/// Values of a row of light: three colours of up to 36 coefficients, in whole vectors, zero beyond.
inline constexpr std::size_t kLightWidth = 48;
struct alignas(64) LightRow {
  float color[3][kLightWidth];
};

/// Matrices of three points, each [colour][row][column], `stride` floats a row and `color_size` a colour; kRowPadding
/// (prt_bake_kernels.h) floats behind the last one may be read. Columns are 1, 9, 16, 25 or 36.
struct MatrixMix {
  const float* matrix[3];
  float share[3];
  std::size_t rows, columns, stride, color_size;
};
/// out += color * (weights . mix of the three matrices), by column: what a lobe, given as weights of the rows, sends on of
/// each of the light's basis functions.
void addLobe(const MatrixMix& mix, const float* weights, const float color[3], LightRow& out);

/// matrix[colour][i][j] += scale * factors[i] * light[colour][j] for j < columns. Up to 15 floats behind the last row are
/// written over with their own value.
struct OuterShape {
  std::size_t rows, columns, stride, color_size;
};
void addOuter(const OuterShape& shape, const float* factors, float scale, const LightRow& light,
              float* matrix);

}  // namespace gloam::prt
