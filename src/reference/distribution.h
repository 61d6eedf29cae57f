// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Choosing one of many by weight.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace gloam::reference {

/// Inverts a cumulative distribution in fixed point, with a table of where to begin (Chen, Asau 1974). Larger numbers choose
/// later entries, so evenly spread numbers choose evenly. What it chooses has exactly the probability that it tells.
class Distribution {
 public:
  Distribution() = default;
  /// Weights that are not positive and finite count as 0. No positive weight: empty().
  explicit Distribution(std::span<const float> weights) : Distribution(weights, 0) {}
  /// With a table of 2^bits parts; 0: about as many as there are weights. With nothing to choose from, both tables below are
  /// there, of zeros.
  Distribution(std::span<const float> weights, int bits);

  bool empty() const { return empty_; }
  struct Choice {
    std::uint32_t index = 0;
    float rest = 0.0f;  ///< where in the entry's share the number fell, in [0, 1]: as even as the number
  };
  Choice choose(std::uint32_t number) const {
    std::uint32_t i = first_[number >> shift_];
    while (i < last_ && starts_[i + 1] <= number) ++i;
    return {i, float(std::int64_t(number - starts_[i])) / float(width(i))};
  }
  float probability(std::uint32_t i) const {
    return !empty_ && i <= last_ ? float(width(i)) * 0x1p-32f : 0.0f;
  }
  /// Least number of each entry; those without a weight start with the next, those after all others with the largest.
  std::span<const std::uint32_t> starts() const { return starts_; }
  /// The entry that holds the first number of each equal part.
  std::span<const std::uint32_t> first() const { return first_; }
  std::uint32_t last() const { return last_; }  ///< entry with a weight

 private:
  std::int64_t width(std::uint32_t i) const {  // signed: floats are made of those at once
    return (i < last_ ? starts_[i + 1] : std::int64_t(1) << 32) - starts_[i];
  }
  std::vector<std::uint32_t> starts_, first_;
  std::uint32_t last_ = 0;  // last entry with a weight
  bool empty_ = true;
  int shift_ = 0;
};

}  // namespace gloam::reference
