// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, equations 11 and 12, in the form of math/sh_high_order.h: visibility is projected alone, to more
// bands, and multiplied with the basis afterwards.
#include "techniques/prt/prt_glossy_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/prt/prt_glossy_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// As in prt_bake_kernels.cpp: no inline function of other headers may be called below.
HWY_BEFORE_NAMESPACE();
namespace gloam::prt::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Vector = hn::Vec<Floats>;

template <class Visit>
HWY_INLINE void forLanes(std::uint32_t bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
}

// kWidth coefficients of all blocked directions; few enough that the sums stay in registers.
template <std::size_t kWidth>
HWY_INLINE void sumColumns(const float* basis, const float* tile_sums, std::size_t stride,
                           const std::uint16_t* blocked, std::size_t tiles, float* sums) {
  const Floats d;
  constexpr std::size_t kLanes = hn::MaxLanes(Floats()), kVectors = kWidth / kLanes;
  Vector acc[kVectors];
  for (std::size_t v = 0; v < kVectors; ++v) acc[v] = hn::Zero(d);
  for (std::size_t t = 0; t < tiles; ++t) {
    const std::uint32_t bits = blocked[t];
    if (bits == 0) continue;
    const float* rows = basis + t * 16 * stride;
    if (hwy::PopCount(bits) <= 8) {
      forLanes(bits, [&](std::size_t k) HWY_ATTR {
        for (std::size_t v = 0; v < kVectors; ++v)
          acc[v] = hn::Add(acc[v], hn::Load(d, rows + k * stride + v * kLanes));
      });
      continue;
    }
    for (std::size_t v = 0; v < kVectors; ++v)
      acc[v] = hn::Add(acc[v], hn::Load(d, tile_sums + t * stride + v * kLanes));
    forLanes(~bits & 0xffffu, [&](std::size_t k) HWY_ATTR {
      for (std::size_t v = 0; v < kVectors; ++v)
        acc[v] = hn::Sub(acc[v], hn::Load(d, rows + k * stride + v * kLanes));
    });
  }
  for (std::size_t v = 0; v < kVectors; ++v) hn::StoreU(acc[v], d, sums + v * kLanes);
}

void SumBlocked(const float* basis, const float* tile_sums, std::size_t stride, const std::uint16_t* blocked,
                std::size_t tiles, float* sums) {
  std::size_t first = 0;
  for (; first + 64 <= stride; first += 64)
    sumColumns<64>(basis + first, tile_sums + first, stride, blocked, tiles, sums + first);
  for (; first < stride; first += 16)
    sumColumns<16>(basis + first, tile_sums + first, stride, blocked, tiles, sums + first);
}

template <std::size_t kVectors>
HWY_INLINE void addLobe(const MatrixMix& mix, const float* weights, const float* color, LightRow& out) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t c = 0; c < 3; ++c) {
    Vector acc[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) acc[v] = hn::Zero(d);
    for (std::size_t m = 0; m < 3; ++m) {
      const float* row = mix.matrix[m] + c * mix.color_size;
      for (std::size_t i = 0; i < mix.rows; ++i, row += mix.stride) {
        const Vector w = hn::Set(d, mix.share[m] * weights[i]);
        for (std::size_t v = 0; v < kVectors; ++v)
          acc[v] = hn::MulAdd(w, hn::LoadU(d, row + v * lanes), acc[v]);
      }
    }
    const Vector tint = hn::Set(d, color[c]);
    for (std::size_t v = 0; v < kVectors; ++v) {
      // The last vector reaches into the next row.
      const Vector valid = hn::IfThenElseZero(hn::FirstN(d, mix.columns - v * lanes), acc[v]);
      float* to = out.color[c] + v * lanes;
      hn::Store(hn::MulAdd(tint, valid, hn::Load(d, to)), d, to);
    }
  }
}

template <std::size_t kVectors>
HWY_INLINE void addOuter(const OuterShape& shape, const float* factors, float scale, const LightRow& light,
                         float* matrix) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const Vector s = hn::Set(d, scale);
  for (std::size_t c = 0; c < 3; ++c) {
    Vector l[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) {
      // Zero beyond the columns: the last vector reaches into the next row.
      l[v] = hn::IfThenElseZero(hn::FirstN(d, shape.columns - v * lanes),
                                hn::Mul(s, hn::Load(d, light.color[c] + v * lanes)));
    }
    float* row = matrix + c * shape.color_size;
    for (std::size_t i = 0; i < shape.rows; ++i, row += shape.stride) {
      const Vector f = hn::Set(d, factors[i]);
      for (std::size_t v = 0; v < kVectors; ++v)
        hn::StoreU(hn::MulAdd(f, l[v], hn::LoadU(d, row + v * lanes)), d, row + v * lanes);
    }
  }
}

// Calls run with the number of vectors as a constant. 36 columns are 9 vectors at most.
#define GLOAM_BY_VECTORS(columns, call)                                  \
  switch (((columns) + hn::Lanes(Floats()) - 1) / hn::Lanes(Floats())) { \
    case 1:                                                              \
      return call(1);                                                    \
    case 2:                                                              \
      return call(2);                                                    \
    case 3:                                                              \
      return call(3);                                                    \
    case 4:                                                              \
      return call(4);                                                    \
    case 5:                                                              \
      return call(5);                                                    \
    case 7:                                                              \
      return call(7);                                                    \
    default:                                                             \
      return call(9);                                                    \
  }

void AddLobe(const MatrixMix& mix, const float* weights, const float* color, LightRow& out) {
#define GLOAM_CALL(vectors) addLobe<vectors>(mix, weights, color, out)
  GLOAM_BY_VECTORS(mix.columns, GLOAM_CALL)
#undef GLOAM_CALL
}

void AddOuter(const OuterShape& shape, const float* factors, float scale, const LightRow& light,
              float* matrix) {
#define GLOAM_CALL(vectors) addOuter<vectors>(shape, factors, scale, light, matrix)
  GLOAM_BY_VECTORS(shape.columns, GLOAM_CALL)
#undef GLOAM_CALL
}
#undef GLOAM_BY_VECTORS

}  // namespace gloam::prt::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::prt {

HWY_EXPORT(SumBlocked);
HWY_EXPORT(AddLobe);
HWY_EXPORT(AddOuter);

void sumBlocked(const float* basis, const float* tile_sums, std::size_t stride, const std::uint16_t* blocked,
                std::size_t tiles, float* sums) {
  HWY_DYNAMIC_DISPATCH(SumBlocked)(basis, tile_sums, stride, blocked, tiles, sums);
}

void addLobe(const MatrixMix& mix, const float* weights, const float color[3], LightRow& out) {
  HWY_DYNAMIC_DISPATCH(AddLobe)(mix, weights, color, out);
}

void addOuter(const OuterShape& shape, const float* factors, float scale, const LightRow& light,
              float* matrix) {
  HWY_DYNAMIC_DISPATCH(AddOuter)(shape, factors, scale, light, matrix);
}

}  // namespace gloam::prt
#endif
