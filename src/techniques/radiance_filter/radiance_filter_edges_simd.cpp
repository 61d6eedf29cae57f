// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pixels beside edges, with the host's vector units: windows that the two passes cut row by row are filtered in one (RF-4), and means of windows that lie to
// one side are carried back to their pixels.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/radiance_filter/radiance_filter_edges_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "gloam/sh.h"
#include "techniques/radiance_filter/radiance_filter_host.h"
#include "techniques/radiance_filter/radiance_filter_line.h"

#ifndef GLOAM_RADIANCE_FILTER_EDGES
#define GLOAM_RADIANCE_FILTER_EDGES
namespace gloam::radiance_filter {

/// Where pixels stand, in halves of a layer: single ones, and runs as long as a vector.
struct Places {
  int singles = 0, runs = 0;
  std::int32_t single[kMostTaps * kMostTaps], run[kMostTaps * kMostTaps / 2];
};

}  // namespace gloam::radiance_filter
#endif

HWY_BEFORE_NAMESPACE();
namespace gloam::radiance_filter {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// How many pixels from one on have whole windows all through: up to a vector of them, or none.
int wholePixels(const HostSurfaces& s, int x, int y, std::uint32_t across, std::uint32_t down,
                int rows_before, int rows) {
  const hn::CappedTag<std::uint32_t, 16> du;
  const auto lanes = int(hn::Lanes(du));
  if (x + lanes > s.width) return 0;
  const std::size_t at = s.pixel(x, y);
  if (!hn::AllTrue(du, hn::Eq(hn::LoadU(du, &s.masks[1][at]), hn::Set(du, down)))) return 0;
  const std::uint32_t* first = &s.masks[0][s.pixel(x, y - rows_before)];
  auto differ = hn::Zero(du);
  for (int j = 0; j < rows; ++j, first += s.width)
    differ = hn::Or(differ, hn::Xor(hn::LoadU(du, first), hn::Set(du, across)));
  return hn::AllTrue(du, hn::Eq(differ, hn::Zero(du))) ? lanes : 0;
}

/// Bits of the reach in row `y` that are of the surface at `at`; `first` is where the reach begins in that row.
std::uint32_t sameInRow(const HostSurfaces& s, std::size_t at, std::size_t first, int reach) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const auto lanes = int(hn::Lanes(d));
  const auto normal_x = hn::Set(d, s.normal_x[at]), normal_y = hn::Set(d, s.normal_y[at]),
             normal_z = hn::Set(d, s.normal_z[at]);
  const auto x = hn::Set(d, s.x[at]), y = hn::Set(d, s.y[at]), z = hn::Set(d, s.z[at]);
  std::uint32_t same = 0;
  for (int i = 0; i < reach; i += lanes) {
    const std::size_t b = first + std::size_t(i);
    const auto off = hn::MulAdd(normal_x, hn::Sub(hn::LoadU(d, &s.x[b]), x),
                                hn::MulAdd(normal_y, hn::Sub(hn::LoadU(d, &s.y[b]), y),
                                           hn::Mul(normal_z, hn::Sub(hn::LoadU(d, &s.z[b]), z))));
    const auto facing = hn::MulAdd(
        normal_x, hn::LoadU(d, &s.normal_x[b]),
        hn::MulAdd(normal_y, hn::LoadU(d, &s.normal_y[b]), hn::Mul(normal_z, hn::LoadU(d, &s.normal_z[b]))));
    const auto near =
        hn::And(hn::Le(hn::Abs(off), hn::Set(d, s.tolerance[at])), hn::Ge(facing, hn::Set(d, kCrease)));
    const auto is =
        hn::And(near, hn::RebindMask(d, hn::Eq(hn::LoadU(du, &s.objects[b]), hn::Set(du, s.objects[at]))));
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, is, bytes);
    same |= (std::uint32_t(bytes[0]) | std::uint32_t(bytes[1]) << 8) << i;
  }
  return reach == 32 ? same : (same & ((1u << reach) - 1u));
}

/// Pixels that a vector holds, four halves each.
int pixelsOfVector() {
  return int(hn::Lanes(hn::CappedTag<float, 16>())) / 4;
}

/// Sums of four halves over places, times `scale`, of kLayers layers side by side.
template <int kLayers>
void sumLayers(const hwy::float16_t* halves, std::size_t layer, const Places& places, float scale,
               std::uint16_t* to) {
  const hn::CappedTag<float, 16> d;
  const hn::CappedTag<float, 4> d4;
  const hn::Rebind<hwy::float16_t, decltype(d)> dh;
  const hn::Rebind<hwy::float16_t, decltype(d4)> dh4;
  hn::Vec<decltype(d)> wide[kLayers];
  hn::Vec<decltype(d4)> sum[kLayers];
  for (int l = 0; l < kLayers; ++l) wide[l] = hn::Zero(d), sum[l] = hn::Zero(d4);
  for (int i = 0; i < places.runs; ++i)
    for (int l = 0; l < kLayers; ++l)
      wide[l] =
          hn::Add(wide[l], hn::PromoteTo(d, hn::LoadU(dh, halves + std::size_t(l) * layer + places.run[i])));
  for (int i = 0; i < places.singles; ++i)
    for (int l = 0; l < kLayers; ++l)
      sum[l] = hn::Add(sum[l],
                       hn::PromoteTo(d4, hn::LoadU(dh4, halves + std::size_t(l) * layer + places.single[i])));
  HWY_ALIGN float parts[16];
  for (int l = 0; l < kLayers; ++l) {
    hn::Store(wide[l], d, parts);
    for (int i = 0; i < pixelsOfVector(); ++i) sum[l] = hn::Add(sum[l], hn::LoadU(d4, parts + 4 * i));
    hn::StoreU(hn::DemoteTo(dh4, hn::Mul(sum[l], hn::Set(d4, scale))), dh4,
               reinterpret_cast<hwy::float16_t*>(to + std::size_t(l) * layer));
  }
}

void sumPlaces(const std::uint16_t* values, std::size_t layer, int layers, const Places& places, float scale,
               std::uint16_t* to) {
  const auto* halves = reinterpret_cast<const hwy::float16_t*>(values);
  int done = 0;
  for (; done + kFieldLayers <= layers; done += kFieldLayers)
    sumLayers<kFieldLayers>(halves + std::size_t(done) * layer, layer, places, scale,
                            to + std::size_t(done) * layer);
  for (; done < layers; ++done)
    sumLayers<1>(halves + std::size_t(done) * layer, layer, places, scale, to + std::size_t(done) * layer);
}

/// here + share (here - relative there), halves `step` apart; the last of all stays.
void carryBack(std::uint16_t* here, const std::uint16_t* there, std::size_t step, int layers, float relative,
               float share) {
  const hn::CappedTag<float, 4> d4;
  const hn::Rebind<hwy::float16_t, decltype(d4)> dh4;
  const std::uint16_t weight = here[std::size_t(layers - 1) * step + 3];
  for (int l = 0; l < layers; ++l) {
    auto* own = reinterpret_cast<hwy::float16_t*>(here + std::size_t(l) * step);
    const auto light = hn::PromoteTo(d4, hn::LoadU(dh4, own));
    const auto other = hn::PromoteTo(
        d4, hn::LoadU(dh4, reinterpret_cast<const hwy::float16_t*>(there + std::size_t(l) * step)));
    const auto way = hn::NegMulAdd(hn::Set(d4, relative), other, light);
    hn::StoreU(hn::DemoteTo(dh4, hn::MulAdd(hn::Set(d4, share), way, light)), dh4, own);
  }
  here[std::size_t(layers - 1) * step + 3] = weight;
}

/// Four halves as they are.
void loadFour(const std::uint16_t* from, float* to) {
  const hn::CappedTag<float, 4> d4;
  const hn::Rebind<hwy::float16_t, decltype(d4)> dh4;
  hn::StoreU(hn::PromoteTo(d4, hn::LoadU(dh4, reinterpret_cast<const hwy::float16_t*>(from))), d4, to);
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::radiance_filter
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::radiance_filter {

HWY_EXPORT(wholePixels);
HWY_EXPORT(sameInRow);
HWY_EXPORT(pixelsOfVector);
HWY_EXPORT(sumPlaces);
HWY_EXPORT(carryBack);
HWY_EXPORT(loadFour);

namespace {

/// True where no row is replaced and all rows of the window took the same taps: then two passes are one.
bool rowsAgree(const HostSurfaces& s, const Line& down, int x, int y) {
  const std::uint32_t own = s.masks[0][s.pixel(x, y)], rows = s.masks[1][s.pixel(x, y)];
  if (rows != down.whole()) return rows == 0;
  for (std::uint32_t left = rows; left != 0; left &= left - 1)
    if (s.masks[0][s.pixel(x, y + std::countr_zero(left) - down.reachBefore())] != own) return false;
  return true;
}

/// What one pass takes around a pixel.
class Taken {
 public:
  Taken(const HostSurfaces& s, const HostFilter& filter)
      : s_(s), across_{filter.taps.x}, down_{filter.taps.y}, run_(HWY_DYNAMIC_DISPATCH(pixelsOfVector)()) {}

  /// Returns how far the middle of what is taken lies off, or kNoShift.
  glm::vec2 at(int x, int y) {
    for (int j = 0; j < down_.reach(); ++j) {
      const int there = y + j - down_.reachBefore();
      same_[j] = there < 0 || there >= s_.height
                     ? 0
                     : HWY_DYNAMIC_DISPATCH(sameInRow)(
                           s_, s_.at(x, y), s_.at(x - across_.reachBefore(), there), across_.reach());
    }
    places.singles = places.runs = pixels_ = 0;
    sum_ = glm::ivec2(0);
    rows_ = 0;
    const int begin = down_.replaces() ? down_.taps - down_.before() : 0;
    for (int j = begin; j < begin + down_.taps; ++j) {
      const std::uint32_t own = across_.chosen(same_[j]);
      take(x, y, j, own);
      if (!down_.replaces()) continue;
      // Sets that this row lacks: from the other row that holds them, first those of its window.
      const int other = j < down_.taps ? j + down_.taps : j - down_.taps;
      const std::uint32_t lacking = across_.whole() & ~across_.setsOf(own);
      take(x, y, other, across_.chosen(same_[other]) & across_.placesOf(lacking));
    }
    if (pixels_ != across_.taps * down_.taps) return glm::vec2(kNoShift);
    const glm::ivec2 whole(down_.taps * Line::sumOf(across_.whole()),
                           across_.taps * Line::sumOf(down_.whole()));
    return glm::vec2(sum_ - whole) / float(pixels_);
  }

  /// True where two passes take the same; then the places are those of the rows, halfway.
  bool isOfTwoPasses(int x, int y) {
    const std::uint32_t rows = s_.masks[1][s_.pixel(x, y)];
    for (std::uint32_t left = rows_; left != 0; left &= left - 1) {
      const int j = std::countr_zero(left);
      if ((rows >> j & 1u) == 0 || s_.masks[0][s_.pixel(x, y + j - down_.reachBefore())] != taps_[j])
        return false;
    }
    if (rows != rows_) return false;
    places.singles = places.runs = 0;
    for (std::uint32_t left = rows; left != 0; left &= left - 1)
      places.single[places.singles++] =
          4 * ((y + std::countr_zero(left) - down_.reachBefore()) * s_.width + x);
    return true;
  }

  Places places;

 private:
  void take(int x, int y, int j, std::uint32_t taps) {
    if (taps == 0) return;
    rows_ |= 1u << j;
    taps_[j] = taps;
    const int row = 4 * ((y + j - down_.reachBefore()) * s_.width + x - across_.reachBefore());
    const std::uint32_t of_run = (1u << run_) - 1u;
    while (taps != 0) {
      const int first = std::countr_zero(taps);
      const bool is_run = (taps >> first & of_run) == of_run;
      const int count = is_run ? run_ : 1;
      (is_run ? places.run[places.runs++] : places.single[places.singles++]) = row + 4 * first;
      taps &= is_run ? ~(of_run << first) : taps - 1;
      pixels_ += count;
      sum_ += glm::ivec2(count * first + count * (count - 1) / 2, count * j);
    }
  }

  const HostSurfaces& s_;
  Line across_, down_;
  int run_, pixels_ = 0;
  glm::ivec2 sum_{0};
  std::uint32_t same_[2 * kMostTaps];
  std::uint32_t rows_ = 0, taps_[2 * kMostTaps];  ///< rows that hold something, and what
};

bool isSame(const HostSurfaces& s, glm::ivec2 p, glm::ivec2 q) {
  const std::size_t a = s.at(p.x, p.y), b = s.at(q.x, q.y);
  const glm::vec3 normal(s.normal_x[a], s.normal_y[a], s.normal_z[a]);
  return s.objects[a] == s.objects[b] &&
         glm::dot(normal, glm::vec3(s.normal_x[b], s.normal_y[b], s.normal_z[b])) >= kCrease &&
         std::abs(glm::dot(normal, glm::vec3(s.x[b] - s.x[a], s.y[b] - s.y[a], s.z[b] - s.z[a]))) <=
             s.tolerance[a];
}

/// How much of a slope is followed: none at steps and turns, all where it goes on (a limiter, after van Leer 1977).
float slopeShare(float slope, float beyond) {
  return slope * beyond > 0.0f ? std::min(1.0f, kSteepest * beyond / slope) : 0.0f;
}

/// One part of the light, from which two windows further on tell the slope.
struct Slope {
  std::uint16_t *here, *near, *far;
  std::size_t step;
  int layers;
  std::span<const float> y;  ///< two bands toward the normal

  /// What a mean gives a surface: irradiance over pi, of a field in two bands.
  glm::vec3 light(const std::uint16_t* at) const {
    float v[12];
    HWY_DYNAMIC_DISPATCH(loadFour)(at, v);
    if (layers != kFieldLayers) return {v[0], v[1], v[2]};
    for (int l = 1; l < 3; ++l) HWY_DYNAMIC_DISPATCH(loadFour)(at + std::size_t(l) * step, v + 4 * l);
    const auto band = [&](std::size_t i) { return glm::vec3(v[3 * i], v[3 * i + 1], v[3 * i + 2]) * y[i]; };
    return band(0) + 2.0f / 3.0f * (band(1) + band(2) + band(3));
  }
  float weight(const std::uint16_t* at) const {
    float four[4];
    HWY_DYNAMIC_DISPATCH(loadFour)(at + std::size_t(layers - 1) * step, four);
    return four[3];
  }

  void follow(float off, float span) const {
    const float near_scale = weight(here) / std::max(weight(near), 1e-6f),
                far_scale = weight(here) / std::max(weight(far), 1e-6f);
    const glm::vec3 own = light(here), there = near_scale * light(near), way = own - there;
    const float slope = (way.x + way.y + way.z) / (span - off);
    const float beyond = glm::dot(there - far_scale * light(far), glm::vec3(1.0f)) / span;
    float share = slopeShare(slope, beyond) * off / (span - off);
    for (int c = 0; c < 3; ++c)
      if (share * way[c] < (kLeastLeft - 1.0f) * own[c])
        share = (kLeastLeft - 1.0f) * std::max(0.0f, own[c]) / way[c];
    if (share != 0.0f) HWY_DYNAMIC_DISPATCH(carryBack)(here, near, step, layers, near_scale, share);
  }
};

}  // namespace

void mendEdges(HostSurfaces& surfaces, const HostFilter& filter, int row,
               std::span<const std::uint16_t> values, std::span<const std::uint16_t> halfway,
               std::span<std::uint16_t> filtered) {
  const HostSurfaces& s = surfaces;
  const Line across{filter.taps.x}, down{filter.taps.y};
  const std::size_t layer = 4 * std::size_t(s.width) * std::size_t(s.height);
  Taken taken(s, filter);
  for (int x = 0; x < s.width; ++x) {
    const std::size_t at = s.pixel(x, row);
    if (const int pixels = HWY_DYNAMIC_DISPATCH(wholePixels)(s, x, row, across.whole(), down.whole(),
                                                             down.before(), down.taps);
        pixels > 0) {
      std::fill_n(&surfaces.shifts[at], pixels, glm::vec2(0.0f));
      x += pixels - 1;
      continue;
    }
    if (rowsAgree(s, down, x, row)) {
      const glm::vec2 shift(across.shift(s.masks[0][at]), down.shift(s.masks[1][at]));
      surfaces.shifts[at] = std::max(shift.x, shift.y) < kNoShift ? shift : glm::vec2(kNoShift);
      continue;
    }
    surfaces.shifts[at] = taken.at(x, row);
    const bool once = !taken.isOfTwoPasses(x, row);
    const int count = once ? filter.taps.x * filter.taps.y : filter.taps.y;
    HWY_DYNAMIC_DISPATCH(sumPlaces)
    ((once ? values : halfway).data(), layer, filter.parts * filter.layers, taken.places, 1.0f / float(count),
     &filtered[4 * at]);
  }
}

void followSlopes(const HostSurfaces& s, const HostFilter& filter, int row,
                  std::span<std::uint16_t> filtered) {
  const auto layer = 4 * std::size_t(s.width) * std::size_t(s.height);
  const int taps = std::max(filter.taps.x, filter.taps.y);
  const glm::ivec2 size(s.width, s.height);
  for (int x = 0; x < s.width; ++x) {
    const glm::ivec2 pixel(x, row);
    const glm::vec2 shift = s.shifts[s.pixel(x, row)];
    if (shift == glm::vec2(0.0f) || shift.x == kNoShift) continue;
    const float off = glm::length(shift);
    if (off < kLeastShift) continue;
    for (const int wanted : {taps + taps / 2, taps}) {
      const glm::ivec2 near = pixel + glm::ivec2(glm::roundEven(shift * (float(wanted) / off))),
                       far = 2 * near - pixel;
      if (glm::any(glm::lessThan(far, glm::ivec2(0))) || glm::any(glm::greaterThanEqual(far, size))) continue;
      const glm::vec2 none(0.0f);
      if (s.shifts[s.pixel(near.x, near.y)] != none || s.shifts[s.pixel(far.x, far.y)] != none) continue;
      if (!isSame(s, pixel, near) || !isSame(s, pixel, far)) continue;
      const float span = glm::dot(glm::vec2(near - pixel), shift / off);
      if (!(span > off)) break;
      const std::size_t at = s.at(x, row);
      const sh::Sh y = sh::evaluate(2, {s.normal_x[at], s.normal_y[at], s.normal_z[at]});
      for (int part = 0; part < filter.parts; ++part) {
        std::uint16_t* of_part = &filtered[std::size_t(part * filter.layers) * layer];
        Slope{of_part + 4 * s.pixel(x, row),
              of_part + 4 * s.pixel(near.x, near.y),
              of_part + 4 * s.pixel(far.x, far.y),
              layer,
              filter.layers,
              {&y[0], 4}}
            .follow(off, span);
      }
      break;
    }
  }
}

}  // namespace gloam::radiance_filter
#endif
