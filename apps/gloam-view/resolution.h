// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How many pixels to draw: fewer while something moves, so that it stays smooth on a software driver; all of them, as far as
// patience goes, when it stands still.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace gloam::view {

class Resolution {
 public:
  float fixed = 0.0f;        ///< share of the window's pixels each way; 0: found
  float moving_ms = 90.0f;   ///< what a picture may take while something moves
  float hurry_ms = 45.0f;    ///< what the first one after a switch may take
  float still_ms = 1500.0f;  ///< what one may take that stands still

  /// Of a picture that took that long: learns what a pixel of its kind (technique and what is shown) costs, apart for small
  /// pictures, in which vertices take their share. A part of the time, kBaseMs, is no pixel's.
  void add(const std::string& kind, double pixels, float scale_drawn, double milliseconds) {
    if (pixels < 1.0) return;
    const double cost = std::max(milliseconds - kBaseMs, 0.1) / pixels;
    const auto [known, fresh] = costs_.try_emplace(keyOf(kind, scale_drawn < kSmall), cost);
    if (!fresh) known->second = 0.5 * known->second + 0.5 * cost;
  }
  /// Whether a picture that stands still took so little that one of more pixels is worth its time.
  bool mayGrow(float scale_drawn, double milliseconds) const {
    return fixed <= 0.0f && scale_drawn < 0.97f && milliseconds < 0.4 * double(still_ms);
  }
  void forget() { costs_.clear(); }
  /// Share of a window of that many pixels; in steps, so that pictures do not change size all the time. `hurry`: the first picture
  /// after a switch, which is waited for.
  float scale(const std::string& kind, double window_pixels, bool moving, bool hurry = false) const {
    if (fixed > 0.0f) return fixed;
    const auto known = costs_.find(keyOf(kind, moving));
    if (known == costs_.end()) return moving ? 0.25f : 0.71f;
    const double affordable = std::max(double(hurry    ? hurry_ms
                                              : moving ? moving_ms
                                                       : still_ms) -
                                           kBaseMs,
                                       5.0) /
                              known->second;
    const double share = std::sqrt(affordable / std::max(window_pixels, 1.0));
    float best = kSteps[0];
    for (const float step : kSteps) {
      if (step <= share * 1.05) best = step;
    }
    return best;
  }

 private:
  static std::string keyOf(const std::string& kind, bool small) { return small ? kind + " small" : kind; }

  static constexpr double kBaseMs = 8.0;
  static constexpr float kSmall = 0.55f;
  static constexpr float kSteps[] = {0.18f, 0.25f, 0.35f, 0.42f, 0.5f, 0.6f, 0.71f, 0.85f, 1.0f};
  std::map<std::string, double> costs_;  ///< milliseconds a pixel
};

}  // namespace gloam::view
