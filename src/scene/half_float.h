// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// IEEE 754 binary16.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace gloam {

inline constexpr float kMostHalf = 65504.0f;

/// Nearest half, ties to even; beyond 65504 in magnitude the largest half of that sign. Not-a-number stays so.
inline std::uint16_t halfFromFloat(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const std::uint16_t sign = std::uint16_t((bits >> 16) & 0x8000u);
  if (std::isnan(value)) return std::uint16_t(sign | 0x7E00u);
  const float magnitude = std::abs(value);
  if (magnitude >= 65504.0f) return std::uint16_t(sign | 0x7BFFu);
  // Halves below 2^-14 are whole multiples of 2^-24.
  if (magnitude < 6.103515625e-5f) {
    return std::uint16_t(sign | std::uint16_t(std::nearbyint(magnitude * 16777216.0f)));
  }
  std::uint32_t rounded = (bits & 0x7FFFFFFFu) + 0x0FFFu + ((bits >> 13) & 1u);
  return std::uint16_t(sign | ((rounded >> 13) - (112u << 10)));
}

inline float floatFromHalf(std::uint16_t half) {
  const float sign = half & 0x8000u ? -1.0f : 1.0f;
  const std::uint32_t exponent = (half >> 10) & 31u, mantissa = half & 1023u;
  if (exponent == 0) return sign * float(mantissa) * 5.9604644775390625e-8f;  // 2^-24
  if (exponent == 31) return mantissa ? std::nanf("") : sign * INFINITY;
  return std::bit_cast<float>(std::uint32_t(half & 0x8000u) << 16 | (exponent + 112u) << 23 | mantissa << 13);
}

}  // namespace gloam
