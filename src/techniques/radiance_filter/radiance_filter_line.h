// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Windows along a line of pixels, as radiance_filter_line.glsl has them.
#pragma once

#include <bit>
#include <cstdint>

#include "techniques/radiance_filter/radiance_filter_shared.h"

namespace gloam::radiance_filter {

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
  /// Sets of pixels, as bits of the whole window.
  std::uint32_t setsOf(std::uint32_t mask) const {
    if (!replaces()) return mask & whole();
    const std::uint32_t early = (1u << taps) - 1u;
    return (mask | (mask & early) << taps | (mask & ~early) >> taps) & whole();
  }
  /// The other way round: all places of sets.
  std::uint32_t placesOf(std::uint32_t sets) const {
    if (!replaces()) return sets;
    const std::uint32_t early = (1u << taps) - 1u;
    return sets | (sets & early) << taps | (sets & ~early) >> taps;
  }
  static int sumOf(std::uint32_t mask) {
    return std::popcount(mask & 0xaaaaaaaau) + 2 * std::popcount(mask & 0xccccccccu) +
           4 * std::popcount(mask & 0xf0f0f0f0u) + 8 * std::popcount(mask & 0xff00ff00u) +
           16 * std::popcount(mask & 0xffff0000u);
  }
  /// Mean place of what is taken past that of the whole window, pixels; kNoShift where sets are missing.
  float shift(std::uint32_t mask) const {
    return std::popcount(mask) != taps ? kNoShift : float(sumOf(mask) - sumOf(whole())) / float(taps);
  }
};

}  // namespace gloam::radiance_filter
