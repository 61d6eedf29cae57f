// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-1 for many directions, one a lane: y_lm = p_lm(z) (Re, Im)(x + i y)^|m| (as in Sloan 2013), all polynomials
// written out. A last, partial vector is computed again together with the directions before it.
#include "math/simd_targets.h"
// clang-format off: Highway compiles this file once an instruction set
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/sh_evaluate_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on
#include <algorithm>
#include <array>

#include "math/sh_batch.h"
#include "math/sh_check.h"
#include "math/sh_constants.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::sh {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kMaxLanes>;
using V = hn::Vec<D>;

/// (x + i y)^m for the m of one band.
struct Powers {
  V re, im;
};

HWY_INLINE Powers timesXy(const Powers& p, V x, V y) {
  return {hn::NegMulAdd(p.im, y, hn::Mul(p.re, x)), hn::MulAdd(p.re, y, hn::Mul(p.im, x))};
}

/// Stores the pair (l, -m), (l, m), whose factor is `norm` times a polynomial in z.
HWY_INLINE void storePair(D d, float* HWY_RESTRICT out, std::size_t stride, int l, int m, V factor,
                          const Powers& p) {
  hn::StoreU(hn::Mul(factor, p.im), d, out + static_cast<std::size_t>(index(l, -m)) * stride);
  hn::StoreU(hn::Mul(factor, p.re), d, out + static_cast<std::size_t>(index(l, m)) * stride);
}

template <int kOrder>
HWY_INLINE void evaluateVector(D d, V x, V y, V z, float* HWY_RESTRICT out, std::size_t stride) {
  const auto set = [d](float value) HWY_ATTR { return hn::Set(d, value); };
  const auto store = [d, out, stride](int i, V value)
                         HWY_ATTR { hn::StoreU(value, d, out + static_cast<std::size_t>(i) * stride); };
  store(0, set(kShNorm00));
  if constexpr (kOrder > 1) {
    const Powers p1{x, y};
    storePair(d, out, stride, 1, 1, set(kShNorm11), p1);
    store(2, hn::Mul(set(kShNorm10), z));
    if constexpr (kOrder > 2) {
      const V zz = hn::Mul(z, z);
      const Powers p2 = timesXy(p1, x, y);
      store(6, hn::MulAdd(set(3.0f * kShNorm20), zz, set(-kShNorm20)));
      storePair(d, out, stride, 2, 1, hn::Mul(set(kShNorm21), z), p1);
      storePair(d, out, stride, 2, 2, set(kShNorm22), p2);
      if constexpr (kOrder > 3) {
        const Powers p3 = timesXy(p2, x, y);
        store(12, hn::Mul(z, hn::MulAdd(set(5.0f * kShNorm30), zz, set(-3.0f * kShNorm30))));
        storePair(d, out, stride, 3, 1, hn::MulAdd(set(5.0f * kShNorm31), zz, set(-kShNorm31)), p1);
        storePair(d, out, stride, 3, 2, hn::Mul(set(kShNorm32), z), p2);
        storePair(d, out, stride, 3, 3, set(kShNorm33), p3);
        if constexpr (kOrder > 4) {
          const Powers p4 = timesXy(p3, x, y);
          const V p40 = hn::MulAdd(set(35.0f * kShNorm40), zz, set(-30.0f * kShNorm40));
          const V p41 = hn::MulAdd(set(7.0f * kShNorm41), zz, set(-3.0f * kShNorm41));
          store(20, hn::MulAdd(p40, zz, set(3.0f * kShNorm40)));
          storePair(d, out, stride, 4, 1, hn::Mul(z, p41), p1);
          storePair(d, out, stride, 4, 2, hn::MulAdd(set(7.0f * kShNorm42), zz, set(-kShNorm42)), p2);
          storePair(d, out, stride, 4, 3, hn::Mul(set(kShNorm43), z), p3);
          storePair(d, out, stride, 4, 4, set(kShNorm44), p4);
          if constexpr (kOrder > 5) {
            const Powers p5 = timesXy(p4, x, y);
            const V p50 = hn::MulAdd(set(63.0f * kShNorm50), zz, set(-70.0f * kShNorm50));
            const V p51 = hn::MulAdd(set(21.0f * kShNorm51), zz, set(-14.0f * kShNorm51));
            const V p52 = hn::MulAdd(set(3.0f * kShNorm52), zz, set(-kShNorm52));
            store(30, hn::Mul(z, hn::MulAdd(p50, zz, set(15.0f * kShNorm50))));
            storePair(d, out, stride, 5, 1, hn::MulAdd(p51, zz, set(kShNorm51)), p1);
            storePair(d, out, stride, 5, 2, hn::Mul(z, p52), p2);
            storePair(d, out, stride, 5, 3, hn::MulAdd(set(9.0f * kShNorm53), zz, set(-kShNorm53)), p3);
            storePair(d, out, stride, 5, 4, hn::Mul(set(kShNorm54), z), p4);
            storePair(d, out, stride, 5, 5, set(kShNorm55), p5);
          }
        }
      }
    }
  }
}

template <int kOrder>
HWY_INLINE void evaluateAll(const float* HWY_RESTRICT x, const float* HWY_RESTRICT y,
                            const float* HWY_RESTRICT z, std::size_t count, float* HWY_RESTRICT out,
                            std::size_t stride) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < count; i += lanes) {
    const std::size_t k = std::min(i, count - lanes);
    evaluateVector<kOrder>(d, hn::LoadU(d, x + k), hn::LoadU(d, y + k), hn::LoadU(d, z + k), out + k, stride);
  }
}

/// At least a vector full of directions.
void evaluateKernel(int order, const float* x, const float* y, const float* z, std::size_t count, float* out,
                    std::size_t stride) {
  switch (order) {
    case 1:
      evaluateAll<1>(x, y, z, count, out, stride);
      break;
    case 2:
      evaluateAll<2>(x, y, z, count, out, stride);
      break;
    case 3:
      evaluateAll<3>(x, y, z, count, out, stride);
      break;
    case 4:
      evaluateAll<4>(x, y, z, count, out, stride);
      break;
    case 5:
      evaluateAll<5>(x, y, z, count, out, stride);
      break;
    default:
      evaluateAll<6>(x, y, z, count, out, stride);
      break;
  }
}

const char* targetName() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::sh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::sh {

HWY_EXPORT(evaluateKernel);
HWY_EXPORT(targetName);

std::string simdTarget() {
  return HWY_DYNAMIC_DISPATCH(targetName)();
}

void checkPlanes(const char* what, std::size_t given, int planes, std::size_t count, std::size_t stride) {
  const auto steps = static_cast<std::size_t>(planes - 1);
  const bool fits = given >= count && (steps == 0 || stride <= (given - count) / steps);
  if (stride < count || !fits)
    throw Error(what, std::to_string(given) + " floats, expected " + std::to_string(planes) + " planes of " +
                          std::to_string(count) + " at a stride of " + std::to_string(stride));
}

void evaluateMany(int order, std::span<const float> x, std::span<const float> y, std::span<const float> z,
                  std::span<float> out, std::size_t stride) {
  checkOrder(order);
  const std::size_t count = x.size();
  if (y.size() != count || z.size() != count) throw Error("evaluateMany", "x, y and z differ in length");
  checkPlanes("evaluateMany: out", out.size(), coefficientCount(order), count, stride);
  if (count == 0) return;
  if (count >= kMaxLanes) {
    HWY_DYNAMIC_DISPATCH(evaluateKernel)(order, x.data(), y.data(), z.data(), count, out.data(), stride);
    return;
  }
  std::array<float, kMaxLanes> px{}, py{}, pz{};
  std::array<float, kMaxLanes * kMaxCoefficients> padded;
  std::copy(x.begin(), x.end(), px.begin());
  std::copy(y.begin(), y.end(), py.begin());
  std::copy(z.begin(), z.end(), pz.begin());
  HWY_DYNAMIC_DISPATCH(evaluateKernel)
  (order, px.data(), py.data(), pz.data(), kMaxLanes, padded.data(), kMaxLanes);
  for (std::size_t i = 0; i < static_cast<std::size_t>(coefficientCount(order)); ++i)
    std::copy_n(padded.data() + i * kMaxLanes, count, out.data() + i * stride);
}

}  // namespace gloam::sh
#endif
