// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Random numbers of a path: Sobol' points, Owen-scrambled by a hash, two dimensions at a time ("padded": every pair of
// dimensions has its own shuffle of the sequence). Nothing is kept between calls: a number follows from seed, pixel, sample
// and dimension alone.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace gloam::reference {

/// The samples of one pixel fill each pair of dimensions evenly: any aligned block of 2^k samples is a (0, 2)-net. Pixels
/// and pairs know nothing of each other.
class Sampler {
 public:
  Sampler(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample);
  /// Both numbers of a pair of dimensions as fractions of 2^32.
  glm::uvec2 bits(std::uint32_t pair) const;
  /// The same in [0, 1).
  glm::vec2 pair(std::uint32_t pair_index) const {
    const glm::uvec2 b = bits(pair_index);
    return {toUnit(b.x), toUnit(b.y)};
  }
  static float toUnit(std::uint32_t bits) { return float(bits >> 8) * 0x1p-24f; }

 private:
  std::uint64_t key_;
  std::uint32_t reversed_sample_;
};

}  // namespace gloam::reference
