// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-3 for the radiance at a neighbourhood's points, band by band: the coefficients of a row (its colours, direct and thrown) are
// lanes, so that a point's numbers are read and written side by side.
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

HWY_BEFORE_NAMESPACE();
namespace gloam::prt {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 8>;
using D16 = hn::Rebind<hwy::float16_t, D>;

constexpr std::size_t kLanes = hn::MaxLanes(D());
constexpr std::size_t kMostValues = 36 * 6 + 8;  // and what a last vector reads beyond them

/// `values` of each of `order`^2 rows.
HWY_INLINE void turnRows(std::size_t order, std::size_t values, const float* rotation, const float* in,
                         float* out) {
  const D d;
  for (std::size_t band = 0; band < order; ++band) {
    const std::size_t width = 2 * band + 1;
    const float* from = in + band * band * values;
    for (std::size_t row = 0; row < width; ++row, rotation += width) {
      float* to = out + (band * band + row) * values;
      for (std::size_t c = 0; c < values; c += kLanes) {
        auto sum = hn::Zero(d);
        for (std::size_t b = 0; b < width; ++b)
          sum = hn::MulAdd(hn::Set(d, rotation[b]), hn::LoadU(d, from + b * values + c), sum);
        hn::StoreU(sum, d, to + c);  // what is beyond the row, the next one writes
      }
    }
  }
}

void turnPoints(const GridToTurn& grid, std::size_t begin, std::size_t end) {
  const D d;
  const D16 d16;
  const auto order = static_cast<std::size_t>(grid.field_order);
  const std::size_t words = order * order * grid.words_of_row, values = 2 * words;
  HWY_ALIGN hwy::float16_t halves[kMostValues] = {};
  HWY_ALIGN float in[kMostValues] = {}, out[kMostValues] = {};
  for (std::size_t point = begin; point < end; ++point) {
    std::memcpy(halves, grid.fields + point * words, 4 * words);
    for (std::size_t i = 0; i < values; i += kLanes)
      hn::StoreU(hn::PromoteTo(d, hn::LoadU(d16, halves + i)), d, in + i);
    turnRows(order, 2 * grid.words_of_row, grid.rotation, in, out);
    for (std::size_t i = 0; i < values; i += kLanes)
      hn::StoreU(hn::DemoteTo(d16, hn::LoadU(d, out + i)), d16, halves + i);
    std::memcpy(grid.radiance + point * words, halves, 4 * words);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::prt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::prt {

HWY_EXPORT(turnPoints);

void turnGrid(const GridToTurn& grid) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grid.points, 256),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      HWY_DYNAMIC_DISPATCH(turnPoints)(grid, range.begin(), range.end());
                    });
}

}  // namespace gloam::prt
#endif
