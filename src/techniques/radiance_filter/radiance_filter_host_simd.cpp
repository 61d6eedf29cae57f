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
#include "techniques/radiance_filter/radiance_filter_surface_simd.h"
// clang-format on
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>

#include "techniques/radiance_filter/radiance_filter_host.h"
#include "techniques/radiance_filter/radiance_filter_line.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::radiance_filter {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
    const Middle middle = Middle::ofEach(s, at);
    auto bits = hn::Zero(du);
    const auto look = [&](std::uint32_t wanted) HWY_ATTR {
      for (int j = first; j < last; ++j) {
        if ((wanted >> j & 1u) != 0)
          bits = hn::Or(
              bits, hn::IfThenElseZero(
                        hn::RebindMask(du, middle.same(s, at + std::size_t((j - line.reachBefore()) * step))),
                        hn::Set(du, 1u << j)));
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

/// True where a vector's pixels all took the same.
HWY_INLINE bool allAre(const std::uint32_t* chosen, int pixels, std::uint32_t bits) {
  return std::all_of(chosen, chosen + pixels, [bits](std::uint32_t of_pixel) { return of_pixel == bits; });
}

/// Mean over the taps of one pixel; halves `step` apart.
void filterPixel(const std::uint16_t* first, std::ptrdiff_t step, std::uint32_t chosen, float share,
                 std::uint16_t* to) {
  const hn::CappedTag<float, 4> d4;
  const hn::Rebind<hwy::float16_t, decltype(d4)> dh4;
  auto sum = hn::Zero(d4);
  for (; chosen != 0; chosen &= chosen - 1)
    sum = hn::Add(sum, hn::PromoteTo(d4, hn::LoadU(dh4, reinterpret_cast<const hwy::float16_t*>(
                                                            first + std::countr_zero(chosen) * step))));
  hn::StoreU(hn::DemoteTo(dh4, hn::Mul(sum, hn::Set(d4, share))), dh4, reinterpret_cast<hwy::float16_t*>(to));
}

/// Sums over runs of `taps` pixels from each on, of a row of halves: twos, fours and so on where that is all, else one by one.
void sumRuns(const std::uint16_t* from, int taps, int width, float* sums) {
  const hn::CappedTag<float, 16> d;
  const hn::Rebind<hwy::float16_t, decltype(d)> dh;
  const int lanes = int(hn::Lanes(d)), count = 4 * width;
  const auto* halves = reinterpret_cast<const hwy::float16_t*>(from);
  const bool doubles = std::has_single_bit(unsigned(taps));
  const int steps = doubles ? 1 : taps;
  for (int i = 0; i + 4 * steps <= count; i += lanes) {
    // The last vector ends with the row, and does some again.
    const int at = std::max(0, std::min(i, count - 4 * (steps - 1) - lanes));
    auto sum = hn::PromoteTo(d, hn::LoadU(dh, halves + at));
    for (int k = 1; k < steps; ++k) sum = hn::Add(sum, hn::PromoteTo(d, hn::LoadU(dh, halves + at + 4 * k)));
    hn::StoreU(sum, d, sums + at);
  }
  for (int run = 1; doubles && run < taps; run *= 2)
    for (int i = 0; i < count; i += lanes)
      hn::StoreU(hn::Add(hn::LoadU(d, sums + i), hn::LoadU(d, sums + i + 4 * run)), d, sums + i);
}

/// RF-4 across: a row of a layer. `sums` has room for a vector and a window more than the row.
void filterAcross(const std::uint16_t* from, int taps, const std::uint32_t* chosen, int width, float* sums,
                  std::uint16_t* to) {
  const hn::CappedTag<float, 16> d;
  const hn::Rebind<hwy::float16_t, decltype(d)> dh;
  const Line line{taps};
  const auto pixels = int(hn::Lanes(d)) / 4;
  const std::uint32_t whole = line.whole();
  const float share = 1.0f / float(taps);
  if (std::find(chosen, chosen + width, whole) != chosen + width && width >= pixels)
    sumRuns(from, taps, width, sums);
  for (int x = 0; x < width;) {
    if (x + pixels <= width && allAre(chosen + x, pixels, 0u)) {
      std::fill_n(to + 4 * x, 4 * pixels, std::uint16_t(0));
      x += pixels;
      continue;
    }
    if (x + pixels <= width && allAre(chosen + x, pixels, whole)) {
      const auto sum = hn::LoadU(d, sums + 4 * (x - line.before()));
      hn::StoreU(hn::DemoteTo(dh, hn::Mul(sum, hn::Set(d, share))), dh,
                 reinterpret_cast<hwy::float16_t*>(to) + 4 * x);
      x += pixels;
      continue;
    }
    filterPixel(from + 4 * (x - line.reachBefore()), 4, chosen[x], share, to + 4 * x);
    ++x;
  }
}

/// RF-4 down: `rows` rows of a layer, one of which is at `from`, halves `step` apart. Windows that lack taps are left as they are.
void filterDown(const std::uint16_t* from, std::ptrdiff_t step, int taps, const std::uint32_t* chosen,
                int rows, int width, std::uint16_t* to) {
  const hn::CappedTag<float, 16> d;
  const hn::Rebind<hwy::float16_t, decltype(d)> dh;
  const Line line{taps};
  const auto pixels = int(hn::Lanes(d)) / 4;
  const std::uint32_t whole = line.whole();
  const float share = 1.0f / float(taps);
  const auto* halves = reinterpret_cast<const hwy::float16_t*>(from);
  const auto load = [&](const hwy::float16_t* at) HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(dh, at)); };
  for (int x = 0; x < width;) {
    const auto all = [&](std::uint32_t bits) HWY_ATTR {
      bool are = x + pixels <= width;
      for (int r = 0; r < rows && are; ++r) are = allAre(chosen + r * width + x, pixels, bits);
      return are;
    };
    if (all(0u)) {
      for (int r = 0; r < rows; ++r) std::fill_n(to + r * step + 4 * x, 4 * pixels, std::uint16_t(0));
      x += pixels;
      continue;
    }
    if (all(whole)) {
      const hwy::float16_t* first = halves + 4 * x - line.before() * step;
      auto sum = load(first);
      for (int j = 1; j < taps; ++j) sum = hn::Add(sum, load(first + j * step));
      for (int r = 0; r < rows; ++r) {
        hn::StoreU(hn::DemoteTo(dh, hn::Mul(sum, hn::Set(d, share))), dh,
                   reinterpret_cast<hwy::float16_t*>(to) + r * step + 4 * x);
        if (r + 1 == rows) break;
        sum = hn::Add(sum, hn::Sub(load(first + (taps + r) * step), load(first + r * step)));
      }
      x += pixels;
      continue;
    }
    for (int r = 0; r < rows; ++r)
      if (const std::uint32_t bits = chosen[r * width + x]; bits == whole || bits == 0)
        filterPixel(from + 4 * x + (r - line.reachBefore()) * step, step, bits, share, to + r * step + 4 * x);
    ++x;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::radiance_filter
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::radiance_filter {

HWY_EXPORT(chooseRow);
HWY_EXPORT(filterAcross);
HWY_EXPORT(filterDown);

HostSurfaces::HostSurfaces(int picture_width, int picture_height)
    : width(picture_width), height(picture_height) {
  const std::size_t count = at(0, height);
  for (std::vector<float>* plane : {&x, &y, &z, &normal_x, &normal_y, &normal_z, &tolerance})
    plane->resize(count);
  objects.resize(count);
  const std::size_t pixels = std::size_t(width) * std::size_t(height);
  for (std::vector<std::uint32_t>& of_axis : masks) of_axis.resize(pixels);
  shifts.resize(pixels);
}

std::size_t HostSurfaces::pixel(int px, int py) const {
  return std::size_t(py) * std::size_t(width) + std::size_t(px);
}

std::size_t HostSurfaces::at(int px, int py) const {
  return std::size_t(py) * std::size_t(width + 2 * kMostTaps) + std::size_t(px + kMostTaps);
}

namespace {

/// Rows of a strip, which one core filters from one end to the other while they are close at hand.
int rowsOfStrip(int height) {
  constexpr int kMost = 64, kLeast = 16;
  const int cores = std::max(1, tbb::this_task_arena::max_concurrency());
  const int rounds = (height + cores * kMost - 1) / (cores * kMost);
  return std::max(kLeast, (height + cores * rounds - 1) / (cores * rounds));
}

/// RF-4 in both passes, of the rows of a strip.
void filterStrip(const HostSurfaces& s, const HostFilter& filter, std::span<const std::uint16_t> values,
                 int first, int end, std::span<std::uint16_t> filtered) {
  constexpr int kRows = 4;  // that share the sums of a window
  const Line down{filter.taps.y};
  const int begin = std::max(0, first - down.reachBefore()),
            stop = std::min(s.height, end - down.reachBefore() + down.reach() - 1);
  const std::size_t row = 4 * std::size_t(s.width), layer = row * std::size_t(s.height);
  std::vector<float> sums(row + 4 * (kMostTaps + 4));
  std::vector<std::uint16_t> halfway(row * std::size_t(stop - begin));
  for (int l = 0; l < filter.parts * filter.layers; ++l) {
    const std::size_t of_layer = std::size_t(l) * layer;
    for (int y = begin; y < stop; ++y) HWY_DYNAMIC_DISPATCH(filterAcross)
    (&values[of_layer + std::size_t(y) * row], filter.taps.x, &s.masks[0][s.pixel(0, y)], s.width,
     sums.data(), &halfway[std::size_t(y - begin) * row]);
    for (int y = first; y < end; y += kRows) HWY_DYNAMIC_DISPATCH(filterDown)
    (&halfway[std::size_t(y - begin) * row], std::ptrdiff_t(row), filter.taps.y, &s.masks[1][s.pixel(0, y)],
     std::min(kRows, end - y), s.width, &filtered[of_layer + std::size_t(y) * row]);
  }
}

}  // namespace

void filterOnHost(HostSurfaces& surfaces, const HostFilter& filter, std::span<const std::uint16_t> values,
                  std::span<std::uint16_t> filtered, const RowDone& done) {
  const int width = surfaces.width, height = surfaces.height;
  tbb::parallel_for(0, height, [&](int y) {
    for (const int axis : {0, 1}) HWY_DYNAMIC_DISPATCH(chooseRow)
    (surfaces, y, axis, filter.taps[axis], &surfaces.masks[axis][surfaces.pixel(0, y)]);
  });
  // Calls f for blocks of a row that have slopes to follow, or that have none.
  const auto eachBlock = [&](int y, bool slopes, const auto& f) {
    for (int x = 0; x < width; x += HostShading::kBlock) {
      const int end = std::min(width, x + HostShading::kBlock);
      if ((filter.slopes && hasSlopes(surfaces, y, x, end)) == slopes) f(x, end);
    }
  };
  const int rows = rowsOfStrip(height);
  tbb::parallel_for(0, (height + rows - 1) / rows, [&](int strip) {
    const int first = rows * strip, end = std::min(height, first + rows);
    filterStrip(surfaces, filter, values, first, end, filtered);
    for (int y = first; y < end; ++y) {
      mendEdges(surfaces, filter, y, values, filtered);
      eachBlock(y, false, [&](int from, int to) { done(y, from, to); });
    }
  });
  tbb::parallel_for(0, height, [&](int y) {
    eachBlock(y, true, [&](int from, int to) {
      followSlopes(surfaces, filter, y, from, to, filtered);
      done(y, from, to);
    });
  });
}

}  // namespace gloam::radiance_filter
#endif
