// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Numbers as they leave for the device: halves in pairs, a word each. For *_simd.cpp files, which Highway compiles once an instruction
// set: it comes behind Highway's own headers.
#if defined(GLOAM_PRT_HALVES_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GLOAM_PRT_HALVES_SIMD_H
#undef GLOAM_PRT_HALVES_SIMD_H
#else
#define GLOAM_PRT_HALVES_SIMD_H
#endif
#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

#include "techniques/prt/prt_shared.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::prt {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kBlockVertices / 2>;
using D16 = hn::Rebind<hwy::float16_t, D>;
using V = hn::Vec<D>;

constexpr std::size_t kLanes = hn::MaxLanes(D());
/// Points that are multiplied together: as many as a block has vertices.
constexpr std::size_t kTile = kBlockVertices;

/// Pairs of rows of sums as halves, a word each point.
HWY_INLINE void putHalves(const float* low, const float* high, std::size_t count, std::size_t stride,
                          std::uint32_t* to) {
  const D d;
  const D16 d16;
  HWY_ALIGN hwy::float16_t halves[2][kTile];
  for (std::size_t v = 0; v < kTile; v += kLanes) {
    hn::StoreU(hn::DemoteTo(d16, hn::LoadU(d, low + v)), d16, halves[0] + v);
    hn::StoreU(hn::DemoteTo(d16, hn::LoadU(d, high + v)), d16, halves[1] + v);
  }
  std::uint16_t bits[2][kTile];
  std::memcpy(bits, halves, sizeof(bits));
  for (std::size_t v = 0; v < count; ++v) to[v * stride] = bits[0][v] | std::uint32_t(bits[1][v]) << 16;
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::prt
HWY_AFTER_NAMESPACE();

#endif
