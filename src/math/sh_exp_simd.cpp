// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-8 for batches, one item a lane: scaling and squaring as in sh_exp.cpp. A vector squares as often as its worst lane
// needs, the others keep theirs.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/sh_exp_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on
#include <algorithm>
#include <array>

#include "math/sh_batch.h"
#include "math/sh_check.h"
#include "math/sh_constants.h"
#include "math/sh_exp_core.h"
#include "math/sh_log_exp.h"
#include "math/sh_tables.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::sh {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, kMaxLanes>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;

/// The coefficients of one vector of items.
struct Block {
  HWY_ALIGN float c[kMaxCoefficients * kMaxLanes];
};

/// out = f * f.
HWY_INLINE void squareBlock(const tables::ProductPlan& plan, std::size_t size, std::size_t lanes,
                            const Block& f, Block& out) {
  const D d;
  for (std::size_t i = 0; i < size; ++i) hn::Store(hn::Zero(d), d, out.c + i * lanes);
  const tables::ProductEntry* entry = plan.entries.data();
  for (const tables::ProductPair& pair : plan.pairs) {
    const V fk = hn::Load(d, f.c + pair.k * lanes);
    V both = hn::Mul(hn::Load(d, f.c + pair.j * lanes), fk);
    if (pair.j != pair.k) both = hn::Add(both, both);
    for (const tables::ProductEntry* end = entry + pair.count; entry != end; ++entry) {
      float* sum = out.c + entry->i * lanes;
      hn::Store(hn::MulAdd(both, hn::Set(d, entry->gamma), hn::Load(d, sum)), d, sum);
    }
  }
}

/// At least a vector full of items.
void expKernel(int order, const ExpCore& core, std::size_t count, const float* HWY_RESTRICT f,
               float* HWY_RESTRICT out, std::size_t stride) {
  const D d;
  const DI di;
  const std::size_t lanes = hn::Lanes(d);
  const auto size = static_cast<std::size_t>(coefficientCount(order));
  const tables::ProductPlan& plan = tables::productPlan(order);
  const auto polynomial = [d](float c0, float c1, float c2, V x) {
    return hn::MulAdd(x, hn::MulAdd(x, hn::Set(d, c2), hn::Set(d, c1)), hn::Set(d, c0));
  };
  const V range = hn::Set(d, core.range), one = hn::Set(d, 1.0f), sqrt_4_pi = hn::Set(d, kShZonal0);
  Block h, g, halved;
  for (std::size_t item = 0; item < count; item += lanes) {
    const std::size_t first = std::min(item, count - lanes);
    V sum = hn::Zero(d);
    for (std::size_t i = 1; i < size; ++i) {
      const V value = hn::LoadU(d, f + i * stride + first);
      sum = hn::MulAdd(value, value, sum);
    }
    const V norm = hn::Sqrt(sum);
    const V longest = hn::Set(d, kShExpNorm);
    const V shortening = hn::IfThenElse(hn::Gt(norm, longest), hn::Div(longest, norm), one);
    // The exponent of norm / range, as frexp has it; 2^-squarings by its bits.
    const V ratio = hn::Div(hn::Mul(norm, shortening), range);
    const auto exponent = hn::Sub(hn::ShiftRight<23>(hn::BitCast(di, ratio)), hn::Set(di, 126));
    const auto squarings = hn::Min(hn::Max(exponent, hn::Zero(di)), hn::Set(di, kShExpSquarings));
    const V scale =
        hn::Mul(shortening, hn::BitCast(d, hn::ShiftLeft<23>(hn::Sub(hn::Set(di, 127), squarings))));
    const V x = hn::Mul(norm, scale);
    const V mean = hn::Exp(d, hn::Div(hn::Mul(hn::LoadU(d, f + first), scale), sqrt_4_pi));
    hn::Store(hn::Zero(d), d, h.c);
    for (std::size_t i = 1; i < size; ++i)
      hn::Store(hn::Mul(scale, hn::LoadU(d, f + i * stride + first)), d, h.c + i * lanes);
    if (core.quadratic) squareBlock(plan, size, lanes, h, g);
    // a 1 + b p h + c p^2 h * h, times a mean.
    const auto coreAt = [&](float p, V times, Block& to) {
      const V y = hn::Mul(hn::Set(d, p), x);
      const V a = hn::MulAdd(hn::Mul(y, y), hn::MulAdd(y, hn::Set(d, core.a3), hn::Set(d, core.a2)), one);
      const V b = hn::Mul(hn::Mul(times, hn::Set(d, p)), polynomial(1.0f, core.b1, core.b2, y));
      const V c = hn::Mul(hn::Mul(times, hn::Set(d, p * p)), polynomial(0.5f, core.c1, core.c2, y));
      for (std::size_t i = 0; i < size; ++i) {
        V value = hn::Mul(b, hn::Load(d, h.c + i * lanes));
        if (core.quadratic) value = hn::MulAdd(c, hn::Load(d, g.c + i * lanes), value);
        hn::Store(value, d, to.c + i * lanes);
      }
      hn::Store(hn::MulAdd(hn::Mul(times, a), sqrt_4_pi, hn::Load(d, to.c)), d, to.c);
    };
    const V from = hn::Set(d, kShExpBlend * core.range);
    if (core.quadratic && !hn::AllFalse(d, hn::Gt(x, from))) {  // expBlend
      const V t = hn::Min(hn::Max(hn::Div(hn::Sub(x, from), hn::Sub(range, from)), hn::Zero(d)), one);
      const V blend = hn::Mul(hn::Mul(t, t), hn::NegMulAdd(hn::Set(d, 2.0f), t, hn::Set(d, 3.0f)));
      coreAt(0.5f, hn::Sqrt(mean), halved);
      coreAt(1.0f, mean, h);
      squareBlock(plan, size, lanes, halved, g);
      for (std::size_t i = 0; i < size * lanes; i += lanes) {
        const V less = hn::Load(d, h.c + i);
        hn::Store(hn::MulAdd(blend, hn::Sub(hn::Load(d, g.c + i), less), less), d, h.c + i);
      }
    } else {
      coreAt(1.0f, mean, h);
    }
    const int most = hn::GetLane(hn::MaxOfLanes(di, squarings));
    for (int k = 0; k < most; ++k) {
      squareBlock(plan, size, lanes, h, g);
      const auto unfinished = hn::RebindMask(d, hn::Gt(squarings, hn::Set(di, k)));
      for (std::size_t i = 0; i < size; ++i)
        hn::Store(hn::IfThenElse(unfinished, hn::Load(d, g.c + i * lanes), hn::Load(d, h.c + i * lanes)), d,
                  h.c + i * lanes);
    }
    for (std::size_t i = 0; i < size; ++i)
      hn::StoreU(hn::Load(d, h.c + i * lanes), d, out + i * stride + first);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::sh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::sh {

HWY_EXPORT(expKernel);

namespace {

void expMany(int order, const ExpCore& core, std::size_t count, std::span<const float> f,
             std::span<float> out, std::size_t stride) {
  const int planes = coefficientCount(order);
  checkPlanes("exponentials: f", f.size(), planes, count, stride);
  checkPlanes("exponentials: out", out.size(), planes, count, stride);
  if (count >= kMaxLanes) {
    HWY_DYNAMIC_DISPATCH(expKernel)(order, core, count, f.data(), out.data(), stride);
  } else if (count > 0) {
    PaddedPlanes padded(f, planes, count, stride);
    HWY_DYNAMIC_DISPATCH(expKernel)
    (order, core, kMaxLanes, padded.in.data(), padded.out.data(), kMaxLanes);
    padded.copyOut(out, planes, count, stride);
  }
}

/// Order 1 has a mean alone, for which any core is exact.
ExpCore coreOrMean(int order, ExpCore (*coreOf)(int order)) {
  checkOrder(order);
  return coreOf(std::max(order, 2));
}

}  // namespace

void expHybridMany(int order, std::size_t count, std::span<const float> f, std::span<float> out,
                   std::size_t stride) {
  expMany(order, coreOrMean(order, hybridCore), count, f, out, stride);
}

void expQuadraticMany(int order, std::size_t count, std::span<const float> f, std::span<float> out,
                      std::size_t stride) {
  expMany(order, coreOrMean(order, quadraticCore), count, f, out, stride);
}

}  // namespace gloam::sh
#endif
