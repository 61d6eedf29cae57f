// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nichols, Wyman 2009, sections 3.2 to 3.5 with the host's vector units; the shaders of the same passes say what differs.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/splatting/splatting_host_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "frame/gbuffer_simd.h"
// clang-format on
#include <algorithm>

#include "techniques/splatting/splatting_host_simd.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::splatting {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, HostPoints::kMultiple>;
using V = hn::Vec<D>;

/// 1 / v to the last bits.
HWY_INLINE V inverseOf(V v) {
  const D d;
  const V guess = hn::ApproximateReciprocal(v);
  return hn::Mul(guess, hn::NegMulAdd(guess, v, hn::Set(d, 2.0f)));
}

using Normal = frame::HWY_NAMESPACE::Vector3<V>;

void PixelRow(const float* depth, const glm::uvec2* normals, int width, bool by_shading, float* const* to) {
  const D d;
  const auto lanes = int(hn::Lanes(d));
  HWY_ALIGN std::uint32_t last_words[2 * HostPoints::kMultiple] = {};
  HWY_ALIGN float last_depth[HostPoints::kMultiple] = {};
  for (int x = 0; x < width; x += lanes) {
    const auto* words = reinterpret_cast<const std::uint32_t*>(normals + x);
    const float* from = depth + x;
    if (x + lanes > width) {
      std::copy_n(words, 2 * (width - x), last_words);
      std::copy_n(from, width - x, last_depth);
      words = last_words;
      from = last_depth;
    }
    Normal n, g;
    frame::HWY_NAMESPACE::readNormals(d, words, &n, by_shading ? nullptr : &g);
    hn::StoreU(hn::LoadU(d, from), d, to[0] + x);
    hn::StoreU(n.x, d, to[1] + x);
    hn::StoreU(n.y, d, to[2] + x);
    hn::StoreU(n.z, d, to[3] + x);
    if (by_shading) continue;
    hn::StoreU(g.x, d, to[4] + x);
    hn::StoreU(g.y, d, to[5] + x);
    hn::StoreU(g.z, d, to[6] + x);
  }
}

void RangesOfPixels(const HostPlan& plan, const float* depth, const glm::uvec2* normals, int row,
                    float* scratch, HostLevel& to) {
  const D d;
  const auto lanes = int(hn::Lanes(d));
  const int pitch = 2 * to.stride;
  float* rows[2][kPixelPlanes];
  for (int r = 0; r < 2; ++r) {
    for (int p = 0; p < kPixelPlanes; ++p) rows[r][p] = scratch + (r * kPixelPlanes + p) * pitch;
    const int y = 2 * row + r;
    std::fill_n(rows[r][0], pitch, 0.0f);
    if (y < plan.height)
      PixelRow(depth + std::size_t(y) * std::size_t(plan.width),
               normals + std::size_t(y) * std::size_t(plan.width), plan.width, plan.by_shading_normal,
               rows[r]);
  }
  float* out[kPlanes];
  for (int p = 0; p < kPlanes; ++p) out[p] = to.plane(p, row);
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f), least = hn::Set(d, -1.0f), two = hn::Set(d, 2.0f);
  const int ranged = plan.by_shading_normal ? 1 : 4;
  for (int x = 0; x < to.width; x += lanes) {
    V low[3] = {one, one, one}, high[3] = {least, least, least}, near = zero, far = two;
    V count = zero, sum = zero, shading[3] = {zero, zero, zero}, middle_x = zero, middle_y = zero;
    for (int r = 0; r < 2; ++r) {
      V depths[2], n[3][2], s[3][2];
      hn::LoadInterleaved2(d, rows[r][0] + 2 * x, depths[0], depths[1]);
      for (int c = 0; c < 3; ++c) {
        hn::LoadInterleaved2(d, rows[r][1 + c] + 2 * x, s[c][0], s[c][1]);
        hn::LoadInterleaved2(d, rows[r][ranged + c] + 2 * x, n[c][0], n[c][1]);
      }
      for (int i = 0; i < 2; ++i) {
        const auto covered = hn::Gt(depths[i], zero);
        const V weight = hn::IfThenElseZero(covered, one);
        near = hn::Max(near, depths[i]);
        far = hn::IfThenElse(covered, hn::Min(far, depths[i]), far);
        for (int c = 0; c < 3; ++c) {
          low[c] = hn::IfThenElse(covered, hn::Min(low[c], n[c][i]), low[c]);
          high[c] = hn::IfThenElse(covered, hn::Max(high[c], n[c][i]), high[c]);
          shading[c] = hn::Add(shading[c], hn::IfThenElseZero(covered, s[c][i]));
        }
        count = hn::Add(count, weight);
        sum = hn::Add(sum, hn::Max(depths[i], zero));
        middle_x = hn::MulAdd(weight, hn::Set(d, 0.5f * float(i) + 0.25f), middle_x);
        middle_y = hn::MulAdd(weight, hn::Set(d, 0.5f * float(r) + 0.25f), middle_y);
      }
    }
    const V scale = hn::Div(one, hn::Max(count, one));
    for (int c = 0; c < 3; ++c) {
      hn::StoreU(low[c], d, out[kLowX + c] + x);
      hn::StoreU(high[c], d, out[kHighX + c] + x);
      hn::StoreU(hn::Mul(shading[c], scale), d, out[kNormalX + c] + x);
    }
    hn::StoreU(near, d, out[kNear] + x);
    hn::StoreU(far, d, out[kFar] + x);
    hn::StoreU(hn::Mul(sum, scale), d, out[kDepth] + x);
    hn::StoreU(hn::Mul(count, hn::Set(d, 0.25f)), d, out[kCovered] + x);
    hn::StoreU(hn::Mul(middle_x, scale), d, out[kMiddleX] + x);
    hn::StoreU(hn::Mul(middle_y, scale), d, out[kMiddleY] + x);
  }
}

/// Both neighbours of a row of texels: those at even and those at odd places.
struct Pair {
  V at[2];
};
HWY_INLINE Pair pairOf(const HostLevel& level, int plane, int row, int x) {
  Pair pair;
  hn::LoadInterleaved2(D(), level.plane(plane, row) + 2 * x, pair.at[0], pair.at[1]);
  return pair;
}

void RangesOfTexels(const HostLevel& from, int row, HostLevel& to) {
  const D d;
  const auto lanes = int(hn::Lanes(d));
  for (int x = 0; x < to.width; x += lanes) {
    const auto store = [&](int plane, V value) HWY_ATTR { hn::StoreU(value, d, to.plane(plane, row) + x); };
    for (int p = kLowX; p <= kFar; ++p) {
      const Pair a = pairOf(from, p, 2 * row, x), b = pairOf(from, p, 2 * row + 1, x);
      const bool greatest = p >= kHighX && p <= kNear;
      store(p, greatest ? hn::Max(hn::Max(a.at[0], a.at[1]), hn::Max(b.at[0], b.at[1]))
                        : hn::Min(hn::Min(a.at[0], a.at[1]), hn::Min(b.at[0], b.at[1])));
    }
    const Pair weights[2] = {pairOf(from, kCovered, 2 * row, x), pairOf(from, kCovered, 2 * row + 1, x)};
    const V all =
        hn::Add(hn::Add(weights[0].at[0], weights[0].at[1]), hn::Add(weights[1].at[0], weights[1].at[1]));
    const V scale = hn::IfThenElseZero(hn::Gt(all, hn::Zero(d)),
                                       hn::Div(hn::Set(d, 1.0f), hn::Max(all, hn::Set(d, 1e-12f))));
    store(kCovered, hn::Mul(all, hn::Set(d, 0.25f)));
    for (int p = kDepth; p < kPlanes; ++p) {
      if (p == kCovered) continue;
      V sum = hn::Zero(d);
      for (int r = 0; r < 2; ++r) {
        const Pair values = pairOf(from, p, 2 * row + r, x);
        for (int i = 0; i < 2; ++i) {
          V value = values.at[i];
          if (p == kMiddleX) value = hn::MulAdd(value, hn::Set(d, 0.5f), hn::Set(d, 0.5f * float(i)));
          if (p == kMiddleY) value = hn::MulAdd(value, hn::Set(d, 0.5f), hn::Set(d, 0.5f * float(r)));
          sum = hn::MulAdd(weights[r].at[i], value, sum);
        }
      }
      store(p, hn::Mul(sum, scale));
    }
  }
}

template <int kBound, bool kMeasures, bool kMerged>
void gatherAs(std::span<const SplatLight> lights, HostPoints& points) {
  const D d;
  const V zero = hn::Zero(d), least = hn::Set(d, 1e-12f);
  for (std::size_t i = 0; i < points.count; i += hn::Lanes(d)) {
    const auto load = [&](const std::vector<float>& from) HWY_ATTR { return hn::LoadU(d, from.data() + i); };
    const V px = load(points.x), py = load(points.y), pz = load(points.z);
    const V nx = load(points.normal_x), ny = load(points.normal_y), nz = load(points.normal_z);
    V red = zero, green = zero, blue = zero, change = zero, error = zero;
    for (const SplatLight& light : lights) {
      const V x = hn::Sub(hn::Set(d, light.position.x), px), y = hn::Sub(hn::Set(d, light.position.y), py),
              z = hn::Sub(hn::Set(d, light.position.z), pz);
      const V here = hn::MulAdd(nx, x, hn::MulAdd(ny, y, hn::Mul(nz, z)));
      const V there = hn::NegMulAdd(
          hn::Set(d, light.normal.x), x,
          hn::NegMulAdd(hn::Set(d, light.normal.y), y, hn::Neg(hn::Mul(hn::Set(d, light.normal.z), z))));
      // Lights stand by side and place, so that many in a row are behind all of these places.
      const V spread = hn::Set(d, light.spread), behind = kMerged ? hn::Neg(spread) : zero;
      if (hn::AllFalse(d, hn::And(hn::Gt(here, behind), hn::Gt(there, behind)))) continue;
      const auto lit = hn::And(hn::Gt(here, zero), hn::Gt(there, zero));
      const V squared = hn::Max(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))), least);
      const V inverse = inverseOf(squared);
      V bounded = inverse;
      if constexpr (kBound == 1) bounded = inverseOf(hn::Max(squared, hn::Set(d, light.bound)));
      if constexpr (kBound == 2) bounded = inverseOf(hn::Add(squared, hn::Set(d, light.bound)));
      const V weight = hn::IfThenElseZero(lit, hn::Mul(hn::Mul(here, there), hn::Mul(inverse, bounded)));
      red = hn::MulAdd(hn::Set(d, light.intensity.x), weight, red);
      green = hn::MulAdd(hn::Set(d, light.intensity.y), weight, green);
      blue = hn::MulAdd(hn::Set(d, light.intensity.z), weight, blue);
      if constexpr (kMeasures || kMerged) {
        V power = hn::Mul(hn::Set(d, light.power), weight);
        if constexpr (kMerged) {
          const V part = hn::Min(hn::Mul(hn::Mul(spread, spread), inverse), hn::Set(d, 1.0f));
          // Where their mean is behind the receiver, or it behind theirs, some of them may not be.
          const V apart = hn::MulAdd(hn::Max(here, zero), hn::Max(hn::Add(there, spread), zero),
                                     hn::Mul(hn::Max(there, zero), hn::Max(hn::Add(here, spread), zero)));
          const V missed = hn::Mul(hn::Mul(hn::Set(d, 0.5f), apart), hn::Mul(inverse, bounded));
          const V changed = hn::Mul(power, part);
          error = hn::Add(
              error, hn::IfThenElse(lit, changed, hn::Mul(hn::Mul(hn::Set(d, light.power), missed), part)));
          power = hn::MulAdd(hn::Set(d, 6.0f), changed, power);
        }
        if constexpr (kMeasures) change = hn::MulAdd(power, inverse, change);
      }
    }
    hn::StoreU(red, d, points.red.data() + i);
    hn::StoreU(green, d, points.green.data() + i);
    hn::StoreU(blue, d, points.blue.data() + i);
    hn::StoreU(change, d, points.change.data() + i);
    hn::StoreU(error, d, points.error.data() + i);
  }
}

template <int kBound>
void gatherBounded(std::span<const SplatLight> lights, bool measures, bool merged, HostPoints& points) {
  if (measures && merged) return gatherAs<kBound, true, true>(lights, points);
  if (measures) return gatherAs<kBound, true, false>(lights, points);
  if (merged) return gatherAs<kBound, false, true>(lights, points);
  gatherAs<kBound, false, false>(lights, points);
}

void Gather(std::span<const SplatLight> lights, int bound_kind, bool measures, bool merged,
            HostPoints& points) {
  if (bound_kind == 0) return gatherBounded<0>(lights, measures, merged, points);
  if (bound_kind == 1) return gatherBounded<1>(lights, measures, merged, points);
  gatherBounded<2>(lights, measures, merged, points);
}

void RelateRow(const HostPlan& plan, int row, HostLevel& level) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const auto lanes = int(hn::Lanes(d));
  const V facets = hn::Set(d, std::max(2.0f * plan.thresholds.normal, 0.4f));
  const V depths = hn::Set(d, 2.0f * plan.thresholds.depth);
  const V range = hn::Set(d, plan.view.depth_range), z_near = hn::Set(d, plan.view.z_near);
  const V tiny = hn::Set(d, 1e-30f), one = hn::Set(d, 1.0f);
  std::uint32_t* bits = level.goes_on.data() + std::size_t(row) * std::size_t(level.stride);
  for (int x = 0; x < level.width; x += lanes) {
    const auto at = [&](int plane, int right, int below)
                        HWY_ATTR { return hn::LoadU(d, level.plane(plane, row + below) + x + right); };
    V here[8];
    for (int p = 0; p < 8; ++p) here[p] = at(p, 0, 0);
    auto found = hn::Zero(du);
    constexpr int kNext[4][2] = {{1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    for (std::uint32_t j = 0; j < 4; ++j) {
      V there[8];
      for (int p = 0; p < 8; ++p) there[p] = at(p, kNext[j][0], kNext[j][1]);
      V span = hn::Zero(d);
      for (int c = 0; c < 3; ++c)
        span = hn::Max(span, hn::Sub(hn::Max(here[kHighX + c], there[kHighX + c]),
                                     hn::Min(here[kLowX + c], there[kLowX + c])));
      const V near = hn::Max(here[kNear], there[kNear]), far = hn::Min(here[kFar], there[kFar]);
      const V apart = plan.view.depth_range <= 0.0f
                          ? hn::Sub(hn::Div(near, hn::Max(far, tiny)), one)
                          : hn::Div(hn::Mul(hn::Sub(near, far), range),
                                    hn::Max(hn::MulAdd(hn::Sub(one, near), range, z_near), tiny));
      const auto together =
          hn::And(hn::Gt(near, hn::Zero(d)), hn::And(hn::Le(span, facets), hn::Le(apart, depths)));
      found = hn::Or(found, hn::IfThenElseZero(hn::RebindMask(du, together), hn::Set(du, 1u << j)));
    }
    hn::StoreU(found, du, bits + x);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::splatting
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::splatting {

HWY_EXPORT(RangesOfPixels);
HWY_EXPORT(RangesOfTexels);
HWY_EXPORT(Gather);
HWY_EXPORT(RelateRow);

void rangesOfPixels(const HostPlan& plan, const float* depth, const glm::uvec2* normals, int row,
                    std::vector<float>& scratch, HostLevel& to) {
  scratch.resize(std::size_t(2 * kPixelPlanes) * 2 * std::size_t(to.stride));
  HWY_DYNAMIC_DISPATCH(RangesOfPixels)(plan, depth, normals, row, scratch.data(), to);
}

void rangesOfTexels(const HostLevel& from, int row, HostLevel& to) {
  HWY_DYNAMIC_DISPATCH(RangesOfTexels)(from, row, to);
}

void gatherOnHost(std::span<const SplatLight> lights, int bound_kind, bool measures, bool merged,
                  HostPoints& points) {
  HWY_DYNAMIC_DISPATCH(Gather)(lights, bound_kind, measures, merged, points);
}

void relateRow(const HostPlan& plan, int row, HostLevel& level) {
  HWY_DYNAMIC_DISPATCH(RelateRow)(plan, row, level);
}

}  // namespace gloam::splatting
#endif
