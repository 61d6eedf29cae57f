// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-8: what scalar, SIMD and fitting code share: the shape of the approximations and how far a function is scaled down.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "math/sh_exp_tables.h"

namespace gloam::sh {

/// f^ is approximated by a 1 + b f^ + c f^ * f^ with x = |f^| <= range, a = 1 + a2 x^2 + a3 x^3,
/// b = 1 + b1 x + b2 x^2, c = 1/2 + c1 x + c2 x^2 (c = 0: HYB's).
struct ExpCore {
  bool quadratic = false;
  float range = 0.0f;
  float a2 = 0.0f, a3 = 0.0f, b1 = 0.0f, b2 = 0.0f, c1 = 0.0f, c2 = 0.0f;

  float a(float x) const { return 1.0f + x * x * (a2 + x * a3); }
  float b(float x) const { return 1.0f + x * (b1 + x * b2); }
  float c(float x) const { return quadratic ? 0.5f + x * (c1 + x * c2) : 0.0f; }
};

/// Of orders 2 to 6, from the tables (sh_exp.cpp).
ExpCore hybridCore(int order);
ExpCore quadraticCore(int order);

/// What f is multiplied by, mean and all, before anything else: 1, or less where f^ is longer than kShExpNorm. So long a
/// sum of logs stands for so many spheres, one behind the other, that fewer look the same; without this their rounding
/// would overflow.
inline float expShortening(float norm) {
  return norm > kShExpNorm ? kShExpNorm / norm : 1.0f;
}

/// How much of the quadratic exponential, at |f^| = x below its range, comes from f / 2 squared: 1 at the range, beyond which all
/// of it does. So nothing jumps where the number of squarings changes.
inline float expBlend(float x, float range) {
  const float t = std::clamp((x / range - kShExpBlend) / (1.0f - kShExpBlend), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// How often a norm of up to kShExpNorm is to be halved until it is within the range: the exponent of norm / range.
inline int expSquarings(float norm, float range) {
  int exponent = 0;
  std::frexp(norm / range, &exponent);
  return std::clamp(exponent, 0, kShExpSquarings);
}

}  // namespace gloam::sh
