// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pixels beside edges, with the host's vector units: windows of which rows would be replaced are filtered in one pass (RF-4), and means of windows that lie to
// one side are carried back to their pixels.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/radiance_filter/radiance_filter_edges_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "techniques/radiance_filter/radiance_filter_surface_simd.h"
// clang-format on
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "math/sh_constants.h"
#include "techniques/radiance_filter/radiance_filter_host.h"
#include "techniques/radiance_filter/radiance_filter_line.h"

#ifndef GLOAM_RADIANCE_FILTER_EDGES
#define GLOAM_RADIANCE_FILTER_EDGES
namespace gloam::radiance_filter {

/// Pixels that are taken, a vector's worth at a time: where the first stands, in halves of a layer, and bits of which.
struct Places {
  int count = 0;
  std::int32_t first[kMostTaps * kMostTaps];
  std::uint32_t bits[kMostTaps * kMostTaps];
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

/// Bits of the reach, in rows one below another, that are of the surface at `at`; `first` is where the first row's reach begins.
void sameInRows(const HostSurfaces& s, std::size_t at, std::size_t first, int reach, int rows,
                std::uint32_t* same_of_row) {
  const Middle::D d;
  const Middle middle = Middle::ofOne(s, at);
  const auto lanes = int(hn::Lanes(d));
  const std::uint32_t of_reach = reach == 32 ? ~0u : (1u << reach) - 1u;
  const std::size_t step = s.at(0, 1) - s.at(0, 0);
  for (int row = 0; row < rows; ++row, first += step) {
    std::uint32_t same = 0;
    for (int i = 0; i < reach; i += lanes) {
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(d, middle.same(s, first + std::size_t(i)), bytes);
      same |= (std::uint32_t(bytes[0]) | std::uint32_t(bytes[1]) << 8) << i;
    }
    same_of_row[row] = same & of_reach;
  }
}

/// Pixels that a vector holds, four halves each.
int pixelsOfVector() {
  return int(hn::Lanes(hn::CappedTag<float, 16>())) / 4;
}

/// All bits of the four numbers of each pixel of a vector that is taken, by the bits of which.
struct Masks {
  HWY_ALIGN std::uint32_t of[16][16];
  constexpr Masks() : of{} {
    for (std::uint32_t bits = 0; bits < 16; ++bits)
      for (std::uint32_t i = 0; i < 16; ++i) of[bits][i] = (bits >> i / 4 & 1u) != 0 ? ~0u : 0u;
  }
};
constexpr Masks kMasks;

/// Sums of four halves over places, times `scale`, of kLayers layers side by side.
template <int kLayers>
void sumLayers(const hwy::float16_t* halves, std::size_t layer, const Places& places, float scale,
               std::uint16_t* to) {
  const hn::CappedTag<float, 16> d;
  const hn::CappedTag<float, 4> d4;
  const hn::RebindToUnsigned<decltype(d)> du;
  const hn::Rebind<hwy::float16_t, decltype(d)> dh;
  const hn::Rebind<hwy::float16_t, decltype(d4)> dh4;
  hn::Vec<decltype(d)> sum[kLayers];
  for (int l = 0; l < kLayers; ++l) sum[l] = hn::Zero(d);
  for (int i = 0; i < places.count; ++i) {
    const auto taken = hn::BitCast(d, hn::LoadU(du, kMasks.of[places.bits[i]]));
    const hwy::float16_t* first = halves + places.first[i];
    for (int l = 0; l < kLayers; ++l)
      sum[l] =
          hn::Add(sum[l], hn::And(taken, hn::PromoteTo(d, hn::LoadU(dh, first + std::size_t(l) * layer))));
  }
  HWY_ALIGN float parts[16];
  for (int l = 0; l < kLayers; ++l) {
    hn::Store(sum[l], d, parts);
    auto four = hn::LoadU(d4, parts);
    for (int i = 1; i < pixelsOfVector(); ++i) four = hn::Add(four, hn::LoadU(d4, parts + 4 * i));
    hn::StoreU(hn::DemoteTo(dh4, hn::Mul(four, hn::Set(d4, scale))), dh4,
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
HWY_EXPORT(sameInRows);
HWY_EXPORT(pixelsOfVector);
HWY_EXPORT(sumPlaces);
HWY_EXPORT(carryBack);
HWY_EXPORT(loadFour);

namespace {

/// How far the middle of what two passes took lies off, where no row is replaced: then each took its sets beside the pixel.
glm::vec2 shiftOfRows(const HostSurfaces& s, const Line& across, const Line& down, int x, int y) {
  if (s.masks[1][s.pixel(x, y)] == 0) return glm::vec2(kNoShift);
  float sum = 0.0f;
  for (int j = 0; j < down.taps; ++j) {
    const float shift = across.shift(s.masks[0][s.pixel(x, y + j - down.before())]);
    if (shift == kNoShift) return glm::vec2(kNoShift);
    sum += shift;
  }
  return {sum / float(down.taps), 0.0f};
}

/// What one pass takes around a pixel.
class Taken {
 public:
  Taken(const HostSurfaces& s, const HostFilter& filter)
      : s_(s),
        across_{filter.taps.x},
        down_{filter.taps.y},
        run_(HWY_DYNAMIC_DISPATCH(pixelsOfVector)()),
        pictures_end_(s.width * s.height) {}

  /// Returns how far the middle of what is taken lies off, or kNoShift.
  glm::vec2 at(int x, int y) {
    places.count = pixels_ = 0;
    sum_ = glm::ivec2(0);
    const int begin = down_.replaces() ? down_.taps - down_.before() : 0, end = begin + down_.taps;
    look(x, y, begin, end);
    std::uint32_t lacking[kMostTaps], any = 0;
    for (int j = begin; j < end; ++j) {
      const std::uint32_t own = across_.chosen(same_[j]);
      take(x, y, j, own);
      any |= lacking[j - begin] = across_.whole() & ~across_.setsOf(own);
    }
    if (any != 0 && down_.replaces()) {
      look(x, y, 0, begin);
      look(x, y, end, down_.reach());
      // Sets that a row lacks: from the other row that holds them, first those of its window.
      for (int j = begin; j < end; ++j) {
        const int other = j < down_.taps ? j + down_.taps : j - down_.taps;
        take(x, y, other, across_.chosen(same_[other]) & across_.placesOf(lacking[j - begin]));
      }
    }
    if (pixels_ != across_.taps * down_.taps) return glm::vec2(kNoShift);
    const glm::ivec2 whole(down_.taps * Line::sumOf(across_.whole()),
                           across_.taps * Line::sumOf(down_.whole()));
    return glm::vec2(sum_ - whole) / float(pixels_);
  }

  Places places;

 private:
  /// Which pixels of rows `begin` to before `end` of the reach are of the same surface.
  void look(int x, int y, int begin, int end) {
    const int top = y - down_.reachBefore();
    std::fill(same_ + begin, same_ + end, 0u);
    begin = std::max(begin, -top), end = std::min(end, s_.height - top);
    if (begin < end) HWY_DYNAMIC_DISPATCH(sameInRows)
    (s_, s_.at(x, y), s_.at(x - across_.reachBefore(), top + begin), across_.reach(), end - begin,
     same_ + begin);
  }

  void take(int x, int y, int j, std::uint32_t taps) {
    if (taps == 0) return;
    const int count = std::popcount(taps);
    pixels_ += count;
    sum_ += glm::ivec2(Line::sumOf(taps), count * j);
    const int row = (y + j - down_.reachBefore()) * s_.width + x - across_.reachBefore();
    while (taps != 0) {
      const int first = std::countr_zero(taps), back = std::max(0, row + first + run_ - pictures_end_);
      const std::uint32_t bits = taps >> first & ((1u << (run_ - back)) - 1u);
      places.first[places.count] = 4 * (row + first - back);
      places.bits[places.count++] = bits << back;
      taps &= ~(bits << first);
    }
  }

  const HostSurfaces& s_;
  Line across_, down_;
  int run_, pictures_end_, pixels_ = 0;
  glm::ivec2 sum_{0};
  std::uint32_t same_[2 * kMostTaps];
};

bool isSame(const HostSurfaces& s, glm::ivec2 p, glm::ivec2 q) {
  std::uint32_t same = 0;
  HWY_DYNAMIC_DISPATCH(sameInRows)(s, s.at(p.x, p.y), s.at(q.x, q.y), 1, 1, &same);
  return same != 0;
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

void followSlope(const HostSurfaces& s, const HostFilter& filter, glm::ivec2 pixel,
                 std::span<std::uint16_t> filtered) {
  const glm::vec2 shift = s.shifts[s.pixel(pixel.x, pixel.y)], none(0.0f);
  if (shift.x == kNoShift) return;
  const float off = glm::length(shift);
  if (off < kLeastShift) return;
  const auto layer = 4 * std::size_t(s.width) * std::size_t(s.height);
  const int taps = std::max(filter.taps.x, filter.taps.y);
  const glm::ivec2 size(s.width, s.height);
  for (const int wanted : {taps + taps / 2, taps}) {
    const glm::ivec2 near = pixel + glm::ivec2(glm::roundEven(shift * (float(wanted) / off))),
                     far = 2 * near - pixel;
    if (glm::any(glm::lessThan(far, glm::ivec2(0))) || glm::any(glm::greaterThanEqual(far, size))) continue;
    if (s.shifts[s.pixel(near.x, near.y)] != none || s.shifts[s.pixel(far.x, far.y)] != none) continue;
    if (!isSame(s, pixel, near) || !isSame(s, pixel, far)) continue;
    const float span = glm::dot(glm::vec2(near - pixel), shift / off);
    if (!(span > off)) return;
    const std::size_t at = s.at(pixel.x, pixel.y);
    const float y[4] = {sh::kShNorm00, sh::kShNorm11 * s.normal_y[at], sh::kShNorm10 * s.normal_z[at],
                        sh::kShNorm11 * s.normal_x[at]};
    for (int part = 0; part < filter.parts; ++part) {
      std::uint16_t* of_part = &filtered[std::size_t(part * filter.layers) * layer];
      Slope{of_part + 4 * s.pixel(pixel.x, pixel.y),
            of_part + 4 * s.pixel(near.x, near.y),
            of_part + 4 * s.pixel(far.x, far.y),
            layer,
            filter.layers,
            y}
          .follow(off, span);
    }
    return;
  }
}

}  // namespace

void mendEdges(HostSurfaces& surfaces, const HostFilter& filter, int row,
               std::span<const std::uint16_t> values, std::span<std::uint16_t> filtered) {
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
    if (s.masks[1][at] == 0 || s.masks[1][at] == down.whole()) {
      surfaces.shifts[at] = shiftOfRows(s, across, down, x, row);
      continue;
    }
    surfaces.shifts[at] = taken.at(x, row);
    HWY_DYNAMIC_DISPATCH(sumPlaces)
    (values.data(), layer, filter.parts * filter.layers, taken.places,
     1.0f / float(filter.taps.x * filter.taps.y), &filtered[4 * at]);
  }
}

bool hasSlopes(const HostSurfaces& s, int row, int from, int to) {
  const glm::vec2* shifts = &s.shifts[s.pixel(0, row)];
  return std::any_of(shifts + from, shifts + to, [](const glm::vec2& shift) {
    return shift.x != kNoShift && glm::dot(shift, shift) >= kLeastShift * kLeastShift;
  });
}

void followSlopes(const HostSurfaces& s, const HostFilter& filter, int row, int from, int to,
                  std::span<std::uint16_t> filtered) {
  for (int x = from; x < to; ++x) followSlope(s, filter, {x, row}, filtered);
}

}  // namespace gloam::radiance_filter
#endif
