// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Equation 13 of Sloan, Kautz, Snyder 2002, the part before the lobe: each vertex's matrices times its object's light, a vertex a
// lane. Row after row is summed in registers; GS is read twice, as it is symmetric, which the second cache holds.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/prt/prt_gloss_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "gpu/format.h"
#include "techniques/prt/prt_halves_simd.h"
#include "techniques/prt/prt_relight_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::prt {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Vectors of a block.
constexpr std::size_t kVectors = kBlockVertices / kLanes;

/// Sizes of one kind of matrix.
struct Shape {
  std::size_t columns, rows, triangle, pairs, direct_words, indirect_words;
  explicit Shape(const GlossInMemory& chunk)
      : columns(std::size_t(chunk.light_order * chunk.light_order)),
        rows(std::size_t(chunk.field_order * chunk.field_order)),
        triangle(columns * (columns + 1) / 2),
        pairs((columns + 1) / 2) {
    const std::size_t values = chunk.cheap ? rows : triangle + (rows - columns) * columns;
    direct_words = chunk.half_float ? (values + 1) / 2 : values;
    indirect_words = rows * pairs * (chunk.half_float ? 3 : 6);
  }
  /// Place of GS' element, as prt_gloss_matrix.glsl has it.
  std::size_t place(std::size_t i, std::size_t j) const {
    if (i >= columns) return triangle + (i - columns) * columns + j;
    return j <= i ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i;
  }
};

/// Numbers of a block's vertices, one after another: [number][vertex], floats or halves in pairs.
template <bool half_float>
HWY_INLINE V numberAt(const std::uint32_t* words, std::size_t number, std::size_t lane) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  if constexpr (!half_float) return hn::BitCast(d, hn::LoadU(du, words + number * kBlockVertices + lane));
  const std::uint32_t* at = words + number / 2 * kBlockVertices + lane;
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(d, gpu::floatFromHalf(static_cast<std::uint16_t>(number % 2 == 0 ? *at : *at >> 16)));
#else
  const auto both = hn::LoadU(du, at);
  const hn::Rebind<std::uint16_t, D> d16;
  const auto one = number % 2 == 0 ? hn::And(both, hn::Set(du, 0xffffu)) : hn::ShiftRight<16>(both);
  return hn::PromoteTo(d, hn::BitCast(D16(), hn::TruncateTo(d16, one)));
#endif
}

/// Sums of so many vectors of a block, by colour.
template <std::size_t count>
struct ColourSums {
  V of[3][count];
  HWY_INLINE ColourSums() {
    for (auto& colour : of)
      for (V& sum : colour) sum = hn::Zero(D());
  }
  HWY_INLINE void store(float* red, float* green, float* blue) const {
    for (std::size_t k = 0; k < count; ++k) {
      hn::StoreU(of[0][k], D(), red + k * kLanes);
      hn::StoreU(of[1][k], D(), green + k * kLanes);
      hn::StoreU(of[2][k], D(), blue + k * kLanes);
    }
  }
};

/// As many as leave registers for the rest.
constexpr std::size_t kTogether = std::min<std::size_t>(kVectors, 4);

/// Row i of GS, or of the light's product matrix times V, for all vertices of a block: three rows of sums.
template <bool half_float>
HWY_INLINE void addDirect(const GlossInMemory& chunk, const Shape& shape, const std::uint32_t* words,
                          const glm::vec3* light, std::size_t i, float (*sums)[kBlockVertices]) {
  const D d;
  const std::size_t count = chunk.cheap ? shape.rows : shape.columns;
  const glm::vec3* factors = chunk.cheap ? light + shape.columns + (1 + i) * shape.rows : light;
  for (std::size_t first = 0; first < kBlockVertices; first += kTogether * kLanes) {
    ColourSums<kTogether> sum;
    for (std::size_t j = 0; j < count; ++j) {
      const std::size_t number = chunk.cheap ? j : shape.place(i, j);
      const V r = hn::Set(d, factors[j].r), g = hn::Set(d, factors[j].g), b = hn::Set(d, factors[j].b);
      for (std::size_t k = 0; k < kTogether; ++k) {
        const V m = numberAt<half_float>(words, number, first + k * kLanes);
        sum.of[0][k] = hn::MulAdd(m, r, sum.of[0][k]);
        sum.of[1][k] = hn::MulAdd(m, g, sum.of[1][k]);
        sum.of[2][k] = hn::MulAdd(m, b, sum.of[2][k]);
      }
    }
    sum.store(sums[0] + first, sums[1] + first, sums[2] + first);
  }
}

/// Row i of GI - GS.
template <bool half_float>
HWY_INLINE void addIndirect(const Shape& shape, const std::uint32_t* words, const glm::vec3* light,
                            std::size_t i, float (*sums)[kBlockVertices]) {
  const D d;
  for (std::size_t first = 0; first < kBlockVertices; first += kTogether * kLanes) {
    ColourSums<kTogether> sum;
    for (std::size_t j = 0; j < shape.columns; ++j) {
      const std::size_t number = 3 * (2 * i * shape.pairs + j);
      for (std::size_t c = 0; c < 3; ++c) {
        const V of_light = hn::Set(d, light[j][int(c)]);
        for (std::size_t k = 0; k < kTogether; ++k)
          sum.of[c][k] =
              hn::MulAdd(numberAt<half_float>(words, number + c, first + k * kLanes), of_light, sum.of[c][k]);
      }
    }
    sum.store(sums[0] + first, sums[1] + first, sums[2] + first);
  }
}

template <bool half_float>
void glossBlocksOf(const GlossInMemory& chunk, std::size_t begin, std::size_t end, const glm::vec3* lights,
                   std::uint32_t* fields) {
  const Shape shape(chunk);
  const std::size_t words = chunk.indirect ? 3 : 2, stride = shape.rows * words;
  HWY_ALIGN float sums[6][kBlockVertices] = {};
  for (std::size_t at = begin; at < end; ++at) {
    const VertexBlock& block = chunk.blocks[at];
    const glm::vec3* light = lights + block.light;
    const std::uint32_t* direct = chunk.direct + block.transfer * shape.direct_words * kBlockVertices;
    const std::uint32_t* indirect =
        chunk.indirect ? chunk.indirect + block.transfer * shape.indirect_words * kBlockVertices : nullptr;
    for (std::size_t i = 0; i < shape.rows; ++i) {
      addDirect<half_float>(chunk, shape, direct, light, i, sums);
      const float factor =
          light[shape.columns + i].x;  // of a lobe that is baked in; rows of GI hold it already
      for (std::size_t c = 0; factor != 1.0f && c < 3; ++c)
        for (float& sum : sums[c]) sum *= factor;
      if (indirect) addIndirect<half_float>(shape, indirect, light, i, sums + 3);
      std::uint32_t* to = fields + block.output_ * stride + i * words;
      putHalves(sums[0], sums[1], block.count, stride, to);
      putHalves(sums[2], sums[3], block.count, stride, to + 1);
      if (indirect) putHalves(sums[4], sums[5], block.count, stride, to + 2);
    }
  }
}

void glossBlocks(const GlossInMemory& chunk, std::size_t begin, std::size_t end, const glm::vec3* lights,
                 std::uint32_t* fields) {
  if (chunk.half_float)
    glossBlocksOf<true>(chunk, begin, end, lights, fields);
  else
    glossBlocksOf<false>(chunk, begin, end, lights, fields);
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::prt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::prt {

HWY_EXPORT(glossBlocks);

void relightGloss(const GlossInMemory& chunk, std::span<const glm::vec3> lights, std::uint32_t* fields) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunk.blocks.size(), 4),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      HWY_DYNAMIC_DISPATCH(glossBlocks)
                      (chunk, range.begin(), range.end(), lights.data(), fields);
                    });
}

}  // namespace gloam::prt
#endif
