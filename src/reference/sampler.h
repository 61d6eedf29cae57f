// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Random numbers of a path: Sobol' points, Owen-scrambled by a hash, two dimensions at a time ("padded": every pair of
// dimensions has its own shuffle of the sequence). Nothing is kept between calls: a number follows from seed, pixel, sample
// and dimension alone.
//
// Burley 2020, "Practical hash-based Owen scrambling": shuffled scrambled Sobol' (0, 2)-sequences, padded. The scrambling
// hash is that of Laine, Karras 2011 with Vegdahl's constants (as in math/sampling.cpp, its slow twin). What differs: bits
// are kept reversed between steps, and the second dimension's matrix, Pascal's triangle modulo 2, is applied in five steps:
// it is the fifth Kronecker power of (1 1; 0 1).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace gloam::reference {

namespace bits {

inline std::uint32_t reversedBits(std::uint32_t v) {
  v = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
  v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
  v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
  v = ((v >> 8) & 0x00ff00ffu) | ((v & 0x00ff00ffu) << 8);
  return (v >> 16) | (v << 16);
}

// Flips each bit by a hash of those below it: Owen scrambling of the reversed number.
inline std::uint32_t scrambled(std::uint32_t v, std::uint32_t seed) {
  v ^= v * 0x3d20adeau;
  v += seed;
  v *= (seed >> 16) | 1u;
  v ^= v * 0x05526c56u;
  v ^= v * 0x53a22864u;
  return v;
}

// Second Sobol' dimension, reversed: bit j is the sum of the bits k of which j's binary digits are a subset.
inline std::uint32_t pascal(std::uint32_t v) {
  v ^= (v >> 1) & 0x55555555u;
  v ^= (v >> 2) & 0x33333333u;
  v ^= (v >> 4) & 0x0f0f0f0fu;
  v ^= (v >> 8) & 0x00ff00ffu;
  return v ^ (v >> 16);
}

// SplitMix64 (Steele, Lea, Flood 2014).
inline std::uint64_t mixed(std::uint64_t v) {
  v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9u;
  v = (v ^ (v >> 27)) * 0x94d049bb133111ebu;
  return v ^ (v >> 31);
}
inline constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;

}  // namespace bits

/// The samples of one pixel fill each pair of dimensions evenly: any aligned block of 2^k samples is a (0, 2)-net. Pixels
/// and pairs know nothing of each other.
class Sampler {
 public:
  Sampler(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample)
      : key_(bits::mixed(bits::mixed(seed + bits::kStep) + (pixel + 1u) * bits::kStep)),
        place_(bits::reversedBits(sample)) {}

  /// What all samples of a pixel have in common in one pair of dimensions.
  struct Scramble {
    std::uint32_t order = 0, x = 0, y = 0;
  };
  Scramble scramble(std::uint32_t pair) const {
    const std::uint64_t a = bits::mixed(key_ + (2u * pair + 1u) * bits::kStep),
                        b = bits::mixed(key_ + (2u * pair + 2u) * bits::kStep);
    return {std::uint32_t(a), std::uint32_t(b), std::uint32_t(b >> 32)};
  }
  /// Of the sample.
  std::uint32_t place() const { return place_; }
  static glm::uvec2 numbers(const Scramble& scramble, std::uint32_t place) {
    const std::uint32_t index = bits::reversedBits(bits::scrambled(place, scramble.order));
    return {bits::reversedBits(bits::scrambled(index, scramble.x)),
            bits::reversedBits(bits::scrambled(bits::pascal(index), scramble.y))};
  }

  /// Both numbers of a pair of dimensions as fractions of 2^32.
  glm::uvec2 numbers(std::uint32_t pair) const { return numbers(scramble(pair), place_); }
  /// The same in [0, 1).
  glm::vec2 pair(std::uint32_t pair_index) const { return unit(numbers(pair_index)); }
  static glm::vec2 unit(const glm::uvec2& numbers) { return {toUnit(numbers.x), toUnit(numbers.y)}; }
  static float toUnit(std::uint32_t bits) { return float(std::int32_t(bits >> 8)) * 0x1p-24f; }

 private:
  std::uint64_t key_;
  std::uint32_t place_;
};

}  // namespace gloam::reference
