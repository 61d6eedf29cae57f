// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Matrices of a neighbourhood's points times the light, a point a lane. Then SH-3 for the radiance there, band by band: the
// coefficients of a row (its colours, direct and thrown) are lanes, so that a point's numbers are read and written side by side.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/prt/prt_neighbourhood_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstring>

#include "techniques/prt/prt_relight_kernel.h"
#include "techniques/prt/prt_sums_simd.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::prt {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMostBands = 121, kMostRowWords = 3 * kMost / 2;

/// Rows of `points` numbers each: a tile's of them, side by side. What lies beyond the last point is 0.
template <class T>
HWY_INLINE void fetch(const T* from, std::size_t stride, std::size_t rows, std::size_t count, T* to) {
  for (std::size_t row = 0; row < rows; ++row, from += stride, to += kTile) {
    std::memcpy(to, from, count * sizeof(T));
    if (count < kTile) std::fill(to + count, to + kTile, T(0));
  }
}

void multiplyTiles(const GridInMemory& grid, std::size_t begin, std::size_t end,
                   std::span<const glm::vec3> lights, std::uint32_t* fields) {
  const auto columns = std::size_t(grid.light_order * grid.light_order);
  const auto rows = std::size_t(grid.field_order * grid.field_order);
  const auto bands = std::size_t(grid.light_order + grid.field_order - 1);
  const std::size_t kept = bands * bands, row_words = (columns + 1) / 2 * 3;
  const std::size_t words = grid.thrown ? 3 : 2, stride = rows * words;
  static const float none[kTile] = {};
  HWY_ALIGN float visibility[kMostBands * kTile];
  HWY_ALIGN std::uint32_t thrown[kMostRowWords * kTile];
  Light light;
  light.set(lights, 0, columns);
  Sums direct, indirect;
  for (std::size_t tile = begin; tile < end; ++tile) {
    const std::size_t point = tile * kTile, count = std::min(kTile, grid.points - point);
    fetch(grid.visibility + point, grid.points, kept, count, visibility);
    for (std::size_t row = 0; row < grid.row_count; ++row) {
      const std::size_t i = grid.first_row + row;
      addFloats<false>(visibility, kept, &lights[columns + i * kept].x, direct);
      std::uint32_t* to = fields + point * stride + i * words;
      putHalves(direct.of[0], direct.of[1], count, stride, to);
      if (!grid.thrown) {
        putHalves(direct.of[2], none, count, stride, to + 1);
        continue;
      }
      fetch(grid.thrown + row * row_words * grid.points + point, grid.points, row_words, count, thrown);
      addHalves<true>(thrown, columns, light, indirect);
      putHalves(direct.of[2], indirect.of[0], count, stride, to + 1);
      putHalves(indirect.of[1], indirect.of[2], count, stride, to + 2);
    }
  }
}

/// A row's numbers fill no wider vectors.
using DRow = hn::CappedTag<float, 8>;
using DRow16 = hn::Rebind<hwy::float16_t, DRow>;

constexpr std::size_t kRowLanes = hn::MaxLanes(DRow());
constexpr std::size_t kMostValues = 36 * 6 + 8;  // and what a last vector reads beyond them

/// `values` of each of `order`^2 rows.
HWY_INLINE void turnRows(std::size_t order, std::size_t values, const float* rotation, const float* in,
                         float* out) {
  const DRow d;
  for (std::size_t band = 0; band < order; ++band) {
    const std::size_t width = 2 * band + 1;
    const float* from = in + band * band * values;
    for (std::size_t row = 0; row < width; ++row, rotation += width) {
      float* to = out + (band * band + row) * values;
      for (std::size_t c = 0; c < values; c += kRowLanes) {
        auto sum = hn::Zero(d);
        for (std::size_t b = 0; b < width; ++b)
          sum = hn::MulAdd(hn::Set(d, rotation[b]), hn::LoadU(d, from + b * values + c), sum);
        hn::StoreU(sum, d, to + c);  // what is beyond the row, the next one writes
      }
    }
  }
}

void turnPoints(const GridToTurn& grid, std::size_t begin, std::size_t end) {
  const DRow d;
  const DRow16 d16;
  const auto order = static_cast<std::size_t>(grid.field_order);
  const std::size_t words = order * order * grid.words_of_row, values = 2 * words;
  HWY_ALIGN hwy::float16_t halves[kMostValues] = {};
  HWY_ALIGN float in[kMostValues] = {}, out[kMostValues] = {};
  for (std::size_t point = begin; point < end; ++point) {
    std::memcpy(halves, grid.fields + point * words, 4 * words);
    for (std::size_t i = 0; i < values; i += kRowLanes)
      hn::StoreU(hn::PromoteTo(d, hn::LoadU(d16, halves + i)), d, in + i);
    turnRows(order, 2 * grid.words_of_row, grid.rotation, in, out);
    for (std::size_t i = 0; i < values; i += kRowLanes)
      hn::StoreU(hn::DemoteTo(d16, hn::LoadU(d, out + i)), d16, halves + i);
    std::memcpy(grid.radiance + point * words, halves, 4 * words);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::prt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::prt {

HWY_EXPORT(multiplyTiles);
HWY_EXPORT(turnPoints);

void multiplyGrid(const GridInMemory& grid, std::span<const glm::vec3> lights, std::uint32_t* fields) {
  const std::size_t tiles = (grid.points + kBlockVertices - 1) / kBlockVertices;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tiles, 4),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      HWY_DYNAMIC_DISPATCH(multiplyTiles)(grid, range.begin(), range.end(), lights, fields);
                    });
}

void turnGrid(const GridToTurn& grid) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grid.points, 256),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      HWY_DYNAMIC_DISPATCH(turnPoints)(grid, range.begin(), range.end());
                    });
}

}  // namespace gloam::prt
#endif
