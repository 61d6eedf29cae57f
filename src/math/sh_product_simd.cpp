// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-6 for batches, one item a lane: for each pair j <= k that has an entry in Gamma, s = f_j g_k + f_k g_j feeds the
// few coefficients i with Gamma_ijk not 0. A last, partial vector is computed again with the items before it.
#include "math/simd_targets.h"
// clang-format off: Highway compiles this file once an instruction set
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/sh_product_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on
#include <algorithm>
#include <array>

#include "math/sh_batch.h"
#include "math/sh_check.h"
#include "math/sh_tables.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::sh {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kMaxLanes>;
using V = hn::Vec<D>;

/// At least a vector full of items.
void productKernel(int order, std::size_t count, const float* HWY_RESTRICT f, const float* HWY_RESTRICT g,
                   float* HWY_RESTRICT out, std::size_t stride) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const tables::ProductPlan& plan = tables::productPlan(order);
  const auto size = static_cast<std::size_t>(coefficientCount(order));
  HWY_ALIGN float sums[kMaxCoefficients * kMaxLanes];
  for (std::size_t item = 0; item < count; item += lanes) {
    const std::size_t first = std::min(item, count - lanes);
    for (std::size_t i = 0; i < size; ++i) hn::Store(hn::Zero(d), d, sums + i * lanes);
    const tables::ProductEntry* entry = plan.entries.data();
    for (const tables::ProductPair& pair : plan.pairs) {
      const std::size_t j = first + pair.j * stride, k = first + pair.k * stride;
      V both = hn::Mul(hn::LoadU(d, f + j), hn::LoadU(d, g + k));
      if (pair.j != pair.k) both = hn::MulAdd(hn::LoadU(d, f + k), hn::LoadU(d, g + j), both);
      for (const tables::ProductEntry* end = entry + pair.count; entry != end; ++entry) {
        float* sum = sums + entry->i * lanes;
        hn::Store(hn::MulAdd(both, hn::Set(d, entry->gamma), hn::Load(d, sum)), d, sum);
      }
    }
    for (std::size_t i = 0; i < size; ++i)
      hn::StoreU(hn::Load(d, sums + i * lanes), d, out + i * stride + first);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::sh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::sh {

HWY_EXPORT(productKernel);

void productMany(int order, std::size_t count, std::span<const float> f, std::span<const float> g,
                 std::span<float> out, std::size_t stride) {
  checkOrder(order);
  const int planes = coefficientCount(order);
  checkPlanes("productMany: f", f.size(), planes, count, stride);
  checkPlanes("productMany: g", g.size(), planes, count, stride);
  checkPlanes("productMany: out", out.size(), planes, count, stride);
  if (count >= kMaxLanes) {
    HWY_DYNAMIC_DISPATCH(productKernel)(order, count, f.data(), g.data(), out.data(), stride);
  } else if (count > 0) {
    PaddedPlanes padded(f, planes, count, stride);
    const PaddedPlanes other(g, planes, count, stride);
    HWY_DYNAMIC_DISPATCH(productKernel)
    (order, kMaxLanes, padded.in.data(), other.in.data(), padded.out.data(), kMaxLanes);
    padded.copyOut(out, planes, count, stride);
  }
}

}  // namespace gloam::sh
#endif
