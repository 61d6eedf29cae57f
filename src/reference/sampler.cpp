// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Burley 2020, "Practical hash-based Owen scrambling": shuffled scrambled Sobol' (0, 2)-sequences, padded. The scrambling
// hash is that of Laine, Karras 2011 with Vegdahl's constants (as in math/sampling.cpp, its slow twin). What differs: bits
// are kept reversed between steps, and the second dimension's matrix, Pascal's triangle modulo 2, is applied in five steps:
// it is the fifth Kronecker power of (1 1; 0 1).
#include "reference/sampler.h"

namespace gloam::reference {
namespace {

std::uint32_t reversedBits(std::uint32_t v) {
  v = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
  v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
  v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(v);
}

// Flips each bit by a hash of those below it: Owen scrambling of the reversed number.
std::uint32_t scrambled(std::uint32_t v, std::uint32_t seed) {
  v ^= v * 0x3d20adeau;
  v += seed;
  v *= (seed >> 16) | 1u;
  v ^= v * 0x05526c56u;
  v ^= v * 0x53a22864u;
  return v;
}

// Second Sobol' dimension, reversed: bit j is the sum of the bits k of which j's binary digits are a subset.
std::uint32_t pascal(std::uint32_t v) {
  v ^= (v >> 1) & 0x55555555u;
  v ^= (v >> 2) & 0x33333333u;
  v ^= (v >> 4) & 0x0f0f0f0fu;
  v ^= (v >> 8) & 0x00ff00ffu;
  return v ^ (v >> 16);
}

// SplitMix64 (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t v) {
  v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9u;
  v = (v ^ (v >> 27)) * 0x94d049bb133111ebu;
  return v ^ (v >> 31);
}
constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;

}  // namespace

Sampler::Sampler(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample)
    : key_(mixed(mixed(seed + kStep) + (pixel + 1u) * kStep)), reversed_sample_(reversedBits(sample)) {}

glm::uvec2 Sampler::bits(std::uint32_t pair) const {
  const std::uint64_t a = mixed(key_ + (2u * pair + 1u) * kStep), b = mixed(key_ + (2u * pair + 2u) * kStep);
  const std::uint32_t index = reversedBits(scrambled(reversed_sample_, std::uint32_t(a)));
  return {reversedBits(scrambled(index, std::uint32_t(b))),
          reversedBits(scrambled(pascal(index), std::uint32_t(b >> 32)))};
}

}  // namespace gloam::reference
