// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace gloam::vpls {

/// Choosing one of many by weight: inverts the running sum. Weights that are not positive and finite count as 0.
class Choice {
 public:
  Choice() = default;
  explicit Choice(std::span<const double> weights) {
    double sum = 0.0;
    for (const double w : weights) sums_.push_back(sum += w > 0.0 && std::isfinite(w) ? w : 0.0);
  }
  double total() const { return sums_.empty() ? 0.0 : sums_.back(); }
  bool empty() const { return !(total() > 0.0); }

  struct Chosen {
    std::size_t index = 0;
    float rest = 0.0f;         ///< where in its share u fell, in [0, 1): as evenly spread as u
    float probability = 0.0f;  ///< 0: there was nothing to choose from
  };
  /// `u` in [0, 1); larger ones choose later entries.
  Chosen choose(float u) const {
    if (empty()) return {};
    const double at = double(u) * total();
    const auto found = std::upper_bound(sums_.begin(), sums_.end(), at);
    const std::size_t i = std::size_t((found == sums_.end() ? lastChosen() : found) - sums_.begin());
    const double before = i > 0 ? sums_[i - 1] : 0.0, width = sums_[i] - before;
    const auto rest = float((at - before) / width);
    return {i, std::clamp(rest, 0.0f, 0.99999994f), float(width / total())};
  }

 private:
  std::vector<double>::const_iterator lastChosen() const {
    return std::lower_bound(sums_.begin(), sums_.end(), sums_.back());
  }
  std::vector<double> sums_;
};

}  // namespace gloam::vpls
