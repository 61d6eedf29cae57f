// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Segovia, Wald 2008, section 3.3 (row RF-4) with the host's vector units: bits of the taps of a row of pixels, then sums of halves.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/radiance_filter/radiance_filter_host_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

#include "techniques/radiance_filter/radiance_filter_host.h"
#include "techniques/radiance_filter/radiance_filter_shared.h"

#ifndef GLOAM_RADIANCE_FILTER_LINE
#define GLOAM_RADIANCE_FILTER_LINE
namespace gloam::radiance_filter {

/// A window along one axis, as radiance_filter_line.glsl has it.
struct Line {
  int taps;
  bool replaces() const { return taps <= kMostTapsReplaced; }
  int before() const { return taps / 2; }
  int reachBefore() const { return replaces() ? taps : before(); }
  int reach() const { return replaces() ? 2 * taps : taps; }
  /// All taps, none replaced.
  std::uint32_t whole() const {
    const std::uint32_t window = taps == 32 ? 0xffffffffu : (1u << taps) - 1u;
    return replaces() ? window << (taps - before()) : window;
  }
  std::uint32_t chosen(std::uint32_t same) const {
    if (!replaces()) return same & whole();
    const std::uint32_t early = (1u << taps) - 1u, missing = ~same & whole();
    return same & (whole() | (missing & early) << taps | (missing & ~early) >> taps);
  }
};

}  // namespace gloam::radiance_filter
#endif

HWY_BEFORE_NAMESPACE();
namespace gloam::radiance_filter {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One pixel a lane, in the middle of its window.
struct Middle {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<hn::CappedTag<float, 16>> du;
  hn::Vec<decltype(du)> object;
  hn::Vec<decltype(d)> x, y, z, normal_x, normal_y, normal_z, tolerance;

  HWY_INLINE Middle(const HostSurfaces& s, std::size_t at)
      : object(hn::LoadU(du, &s.objects[at])),
        x(hn::LoadU(d, &s.x[at])),
        y(hn::LoadU(d, &s.y[at])),
        z(hn::LoadU(d, &s.z[at])),
        normal_x(hn::LoadU(d, &s.normal_x[at])),
        normal_y(hn::LoadU(d, &s.normal_y[at])),
        normal_z(hn::LoadU(d, &s.normal_z[at])),
        tolerance(hn::LoadU(d, &s.tolerance[at])) {}

  /// `bit` where the pixels there are of its surface.
  HWY_INLINE hn::Vec<decltype(du)> same(const HostSurfaces& s, std::size_t there, std::uint32_t bit) const {
    const auto off = hn::MulAdd(normal_x, hn::Sub(hn::LoadU(d, &s.x[there]), x),
                                hn::MulAdd(normal_y, hn::Sub(hn::LoadU(d, &s.y[there]), y),
                                           hn::Mul(normal_z, hn::Sub(hn::LoadU(d, &s.z[there]), z))));
    const auto facing = hn::MulAdd(normal_x, hn::LoadU(d, &s.normal_x[there]),
                                   hn::MulAdd(normal_y, hn::LoadU(d, &s.normal_y[there]),
                                              hn::Mul(normal_z, hn::LoadU(d, &s.normal_z[there]))));
    const auto near = hn::And(hn::Le(hn::Abs(off), tolerance), hn::Ge(facing, hn::Set(d, kCrease)));
    const auto is = hn::And(hn::RebindMask(du, near), hn::Eq(object, hn::LoadU(du, &s.objects[there])));
    return hn::IfThenElseZero(is, hn::Set(du, bit));
  }
};

/// The taps that are taken, of the pixels of row `y`. Taps are `step` numbers of a plane apart.
void chooseRow(const HostSurfaces& s, int y, int axis, int taps, std::uint32_t* chosen) {
  const hn::CappedTag<std::uint32_t, 16> du;
  const Line line{taps};
  const auto lanes = int(hn::Lanes(du));
  const std::ptrdiff_t step = axis == 0 ? 1 : std::ptrdiff_t(s.at(0, 1)) - std::ptrdiff_t(s.at(0, 0));
  const int first = axis == 0 ? 0 : std::max(0, line.reachBefore() - y);
  const int last = axis == 0 ? line.reach() : std::min(line.reach(), s.height - y + line.reachBefore());
  const std::uint32_t whole = line.whole();
  for (int x = 0; x < s.width; x += lanes) {
    const std::size_t at = s.at(x, y);
    const Middle middle(s, at);
    auto bits = hn::Zero(du);
    const auto look = [&](std::uint32_t wanted) HWY_ATTR {
      for (int j = first; j < last; ++j) {
        if ((wanted >> j & 1u) != 0)
          bits = hn::Or(bits, middle.same(s, at + std::size_t((j - line.reachBefore()) * step), 1u << j));
      }
    };
    look(whole);
    if (!hn::AllTrue(du, hn::Eq(bits, hn::Set(du, whole))))
      look(~whole);  // what may take places of missing taps
    HWY_ALIGN std::uint32_t of_lane[16];
    hn::Store(bits, du, of_lane);
    for (int i = 0; i < lanes && x + i < s.width; ++i)
      chosen[x + i] = s.objects[at + std::size_t(i)] == 0 ? 0u : line.chosen(of_lane[i]);
  }
}

/// Means over the taps of a row of pixels; halves `step` apart.
void filterRow(const std::uint16_t* from, std::ptrdiff_t step, int taps, const std::uint32_t* chosen,
               int width, std::uint16_t* to) {
  const hn::CappedTag<float, 16> d;
  const hn::CappedTag<float, 4> d4;
  const hn::Rebind<hwy::float16_t, decltype(d)> dh;
  const hn::Rebind<hwy::float16_t, decltype(d4)> dh4;
  const Line line{taps};
  const auto pixels = int(hn::Lanes(d)) / 4;
  const std::uint32_t whole = line.whole();
  const auto isWhole = [whole](std::uint32_t bits) { return bits == whole; };
  const float share = 1.0f / float(taps);
  const auto* halves = reinterpret_cast<const hwy::float16_t*>(from);
  auto* means = reinterpret_cast<hwy::float16_t*>(to);
  for (int x = 0; x < width;) {
    const hwy::float16_t* here = halves + 4 * x - line.reachBefore() * step;
    if (x + pixels <= width && std::all_of(chosen + x, chosen + x + pixels, isWhole)) {
      auto sum = hn::Zero(d);
      const int first = std::countr_zero(whole);
      for (int j = first; j < first + taps; ++j)
        sum = hn::Add(sum, hn::PromoteTo(d, hn::LoadU(dh, here + j * step)));
      hn::StoreU(hn::DemoteTo(dh, hn::Mul(sum, hn::Set(d, share))), dh, means + 4 * x);
      x += pixels;
      continue;
    }
    auto sum = hn::Zero(d4);
    for (std::uint32_t left = chosen[x]; left != 0; left &= left - 1)
      sum = hn::Add(sum, hn::PromoteTo(d4, hn::LoadU(dh4, here + std::countr_zero(left) * step)));
    hn::StoreU(hn::DemoteTo(dh4, hn::Mul(sum, hn::Set(d4, share))), dh4, means + 4 * x);
    ++x;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::radiance_filter
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::radiance_filter {

HWY_EXPORT(chooseRow);
HWY_EXPORT(filterRow);

HostSurfaces::HostSurfaces(int picture_width, int picture_height)
    : width(picture_width), height(picture_height) {
  const std::size_t count = at(0, height);
  for (std::vector<float>* plane : {&x, &y, &z, &normal_x, &normal_y, &normal_z, &tolerance})
    plane->resize(count);
  objects.resize(count);
}

std::size_t HostSurfaces::at(int px, int py) const {
  return std::size_t(py) * std::size_t(width + 2 * kMostTaps) + std::size_t(px + kMostTaps);
}

void filterOnHost(const HostSurfaces& surfaces, glm::ivec2 taps, int layers,
                  std::span<const std::uint16_t> values, std::span<std::uint16_t> halfway,
                  std::span<std::uint16_t> filtered, const std::function<void(int)>& done) {
  const auto row = std::size_t(4 * surfaces.width), layer = row * std::size_t(surfaces.height);
  for (int axis = 0; axis < 2; ++axis) {
    const std::uint16_t* from = axis == 0 ? values.data() : halfway.data();
    std::uint16_t* to = axis == 0 ? halfway.data() : filtered.data();
    tbb::parallel_for(0, surfaces.height, [&](int y) {
      std::vector<std::uint32_t> chosen(std::size_t(surfaces.width));
      HWY_DYNAMIC_DISPATCH(chooseRow)(surfaces, y, axis, taps[axis], chosen.data());
      for (int l = 0; l < layers; ++l) {
        const std::size_t at = std::size_t(l) * layer + std::size_t(y) * row;
        HWY_DYNAMIC_DISPATCH(filterRow)
        (from + at, axis == 0 ? 4 : std::ptrdiff_t(row), taps[axis], chosen.data(), surfaces.width, to + at);
      }
      if (axis == 1) done(y);
    });
  }
}

}  // namespace gloam::radiance_filter
#endif
