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
  /// pictures, in which vertices take their share. A part of the time, kBaseMs, is no pixel's; of pictures so small that it is
  /// all of it, nothing is learnt.
  void add(const std::string& kind, double pixels, float scale_drawn, double milliseconds) {
    if (pixels < kFewPixels) return;
    const double cost = std::max(milliseconds - kBaseMs, 0.1) / pixels;
    const auto [known, fresh] = costs_.try_emplace(keyOf(kind, scale_drawn < kSmall), cost);
    if (!fresh) known->second = 0.5 * known->second + 0.5 * cost;
  }
  /// Whether a picture that stands still took so little that one of more pixels is worth its time.
  bool mayGrow(float scale_drawn, double milliseconds) const {
    return fixed <= 0.0f && scale_drawn < 0.97f && milliseconds < 0.4 * double(still_ms);
  }
  /// The share after one that may grow: a step more at least, whatever was learnt before.
  float grown(float share, float scale_drawn) const {
    if (fixed > 0.0f) return fixed;
    for (const float step : kSteps) {
      if (step > scale_drawn * 1.03f) return std::max(share, step);
    }
    return 1.0f;
  }
  void forget() { costs_.clear(); }
  /// Tells how many pixels the window has. What was learnt in one of another order of size does not hold.
  void fit(double window_pixels) {
    const double ratio = window_pixels / std::max(learnt_in_, 1.0);
    if (ratio > 0.25 && ratio < 4.0) return;
    learnt_in_ = window_pixels;
    forget();
  }
  /// Share of a window of that many pixels; in steps, so that pictures do not change size all the time. `hurry`: the first picture
  /// after a switch, which is waited for.
  float scale(const std::string& kind, double window_pixels, bool moving, bool hurry = false) const {
    if (fixed > 0.0f) return fixed;
    const double fewest = std::sqrt(kFewPixels / std::max(window_pixels, 1.0));
    const double share = std::max(affordable(kind, window_pixels, moving, hurry), fewest);
    if (hurry && share * 1.05 < kSteps[0] && fewest < kHurried) return kHurried;
    float best = kSteps[0];
    for (const float step : kSteps) {
      if (best < fewest || step <= share * 1.05) best = step;
    }
    return best;
  }

 private:
  double affordable(const std::string& kind, double window_pixels, bool moving, bool hurry) const {
    const double patience_ms = double(hurry ? hurry_ms : moving ? moving_ms : still_ms) - kBaseMs;
    const auto shareBy = [&](bool small, double unknown) {
      const auto known = costs_.find(keyOf(kind, small));
      if (known == costs_.end()) return unknown;
      return std::sqrt(std::max(patience_ms, 5.0) / known->second / std::max(window_pixels, 1.0));
    };
    const auto guess = [&](double most, double pixels) {
      return std::min(most, std::sqrt(pixels / std::max(window_pixels, 1.0)));
    };
    if (!moving) return shareBy(false, guess(0.71, kFirstStillPixels));
    const double share = shareBy(true, guess(0.25, kFirstMovingPixels));
    // What small pictures promise of large ones is held to what those took.
    return share < double(kSmall) ? share
                                  : std::min(share, std::max(shareBy(false, share), double(kLargestSmall)));
  }
  static std::string keyOf(const std::string& kind, bool small) { return small ? kind + " small" : kind; }

  static constexpr double kBaseMs = 8.0, kFewPixels = 4096.0;
  static constexpr double kFirstStillPixels = 7e5, kFirstMovingPixels = 1e5;  ///< where nothing is learnt yet
  static constexpr float kSmall = 0.55f, kLargestSmall = 0.5f;
  static constexpr float kHurried =
      0.11f;  ///< below all steps: what these cannot show in time is seen at once, if coarsely
  static constexpr float kSteps[] = {0.18f, 0.25f, 0.35f, 0.42f, 0.5f, 0.6f, 0.71f, 0.85f, 1.0f};
  std::map<std::string, double> costs_;  ///< milliseconds a pixel
  double learnt_in_ = 0.0;               ///< pixels of the window
};

}  // namespace gloam::view
