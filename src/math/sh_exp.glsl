// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-8 in shaders: the exponentials of math/sh_log_exp.h under the same names, orders 3 and 4 (sh_exp_high.glsl: 5, 6);
// the method is told in sh_exp.cpp. Each function holds its product once, in a loop, for products are long code. All
// else is written out: Mesa's software driver leaves loops over arrays as they are inside such a loop, and keeps the
// arrays in memory then (four to eight times slower at orders 5 and 6).
#ifndef GLOAM_MATH_SH_EXP_GLSL
#define GLOAM_MATH_SH_EXP_GLSL

#include "math/sh_constants.h"
#include "math/sh_exp_tables.h"
#include "math/sh_product.glsl"

/// How often a norm is to be halved until it is within the range.
int shExpSquarings(float norm, float range) {
  int exponent;
  frexp(norm / range, exponent);
  return clamp(exponent, 0, kShExpSquarings);
}

// S(i) of all coefficients but the mean's.
#define GLOAM_SH_REST_3(S) \
  S(1) S(2) S(3) S(4) S(5) S(6) S(7) S(8)
#define GLOAM_SH_REST_4(S) \
  GLOAM_SH_REST_3(S) S(9) S(10) S(11) S(12) S(13) S(14) S(15)
#define GLOAM_SH_REST_5(S) \
  GLOAM_SH_REST_4(S) S(16) S(17) S(18) S(19) S(20) S(21) S(22) S(23) S(24)
#define GLOAM_SH_REST_6(S) \
  GLOAM_SH_REST_5(S) S(25) S(26) S(27) S(28) S(29) S(30) S(31) S(32) S(33) S(34) S(35)
#define GLOAM_SH_ADD_SQUARE(i) norm += f[i] * f[i];
#define GLOAM_SH_SCALE(i) h[i] = scale * f[i];
#define GLOAM_SH_TIMES_B(i) h[i] *= b;
#define GLOAM_SH_TAKE(i) h[i] = g[i];
#define GLOAM_SH_CLEAR(i) less[i] = 0.0f;
#define GLOAM_SH_COMBINE(i) {                                  \
    float was = h[i];                                          \
    h[i] = half_b * was + half_c * g[i] + part * less[i];      \
    less[i] = b * was + c * g[i];                              \
  }
#define GLOAM_SH_FIRST_TERM(i) term[i] = f[i]; rest[i] = f[i]; h[i] = f[i];
#define GLOAM_SH_NEXT_TERM(i) term[i] = g[i] / float(n); h[i] += term[i];

/// Length of f without its mean.
#define GLOAM_SH_NORM(order)                          \
  float norm = 0.0f;                                  \
  GLOAM_SH_REST_##order(GLOAM_SH_ADD_SQUARE)          \
  norm = sqrt(norm);

// f without its mean, scaled until it is within the core's range: h; x is its norm, mean that of f, scaled likewise.
// Too long an f is shortened as a whole (expShortening in sh_exp_core.h).
#define GLOAM_SH_SCALE_DOWN(order, core)                               \
  GLOAM_SH_NORM(order)                                                 \
  float shortening = norm > kShExpNorm ? kShExpNorm / norm : 1.0f;     \
  int squarings = shExpSquarings(norm * shortening, core[0]);          \
  float scale = ldexp(shortening, -squarings);                         \
  float x = norm * scale;                                              \
  float mean = exp(f[0] * scale / kShZonal0);                          \
  GLOAM_SH_REST_##order(GLOAM_SH_SCALE)                                \
  float a = mean * (1.0f + x * x * (core[1] + x * core[2])) * kShZonal0; \
  float b = mean * (1.0f + x * (core[3] + x * core[4]));

#define GLOAM_SH_EXP_HYBRID(order, size)                               \
  GLOAM_SH_SCALE_DOWN(order, kShExpHybrid##order)                      \
  GLOAM_SH_REST_##order(GLOAM_SH_TIMES_B)                              \
  h[0] = a;                                                            \
  for (int k = 0; k < squarings; ++k) {                                \
    float g[size];                                                     \
    shProduct##order(h, h, g);                                         \
    GLOAM_SH_TAKE(0)                                                   \
    GLOAM_SH_REST_##order(GLOAM_SH_TAKE)                               \
  }

/// How much comes from f / 2 squared, below the range: all of it there, so that nothing jumps where squarings change.
float shExpBlend(float x, float range) {
  return smoothstep(kShExpBlend * range, range, x);
}

// The first round makes a 1 + b h + c h * h, the others square. Where two numbers of squarings are blended it makes the same of
// h / 2, whose square the second round takes `blend` of, and of `less`, which is that of h, the rest.
#define GLOAM_SH_EXP_QUADRATIC(order, size)                                                      \
  GLOAM_SH_SCALE_DOWN(order, kShExpQuadratic##order)                                             \
  float c = mean * (0.5f + x * (kShExpQuadratic##order[5] + x * kShExpQuadratic##order[6]));     \
  float blend = shExpBlend(x, kShExpQuadratic##order[0]);                                        \
  float half_a = a, half_b = b, half_c = c, part = 0.0f;                                         \
  if (blend > 0.0f) {                                                                            \
    float y = 0.5f * x, half_mean = sqrt(mean);                                                  \
    half_a = half_mean * (1.0f + y * y * (kShExpQuadratic##order[1] + y * kShExpQuadratic##order[2])) * kShZonal0; \
    half_b = half_mean * (0.5f + 0.5f * y * (kShExpQuadratic##order[3] + y * kShExpQuadratic##order[4]));          \
    half_c = half_mean * (0.125f + 0.25f * y * (kShExpQuadratic##order[5] + y * kShExpQuadratic##order[6]));       \
    ++squarings;                                                                                 \
  }                                                                                              \
  float less[size];                                                                              \
  GLOAM_SH_CLEAR(0)                                                                              \
  GLOAM_SH_REST_##order(GLOAM_SH_CLEAR)                                                          \
  h[0] = 0.0f;                                                                                   \
  for (int k = 0; k <= squarings; ++k) {                                                         \
    float g[size];                                                                               \
    shProduct##order(h, h, g);                                                                   \
    GLOAM_SH_COMBINE(0)                                                                          \
    GLOAM_SH_REST_##order(GLOAM_SH_COMBINE)                                                      \
    h[0] += half_a;                                                                              \
    less[0] += a;                                                                                \
    a = half_a = b = c = half_b = 0.0f;                                                          \
    part = k == 0 && blend > 0.0f ? 1.0f - blend : 0.0f;                                         \
    half_c = 1.0f - part;                                                                        \
  }

#define GLOAM_SH_EXP_LINEAR(order)                                                           \
  GLOAM_SH_NORM(order)                                                                       \
  float place = min(norm / kShExpLinearStep, float(kShExpLinearEntries - 1));                \
  int below = min(int(place), kShExpLinearEntries - 2);                                      \
  float t = place - float(below);                                                            \
  float mean = exp(f[0] / kShZonal0);                                                        \
  float scale = mean * mix(kShExpLinearB##order[below], kShExpLinearB##order[below + 1], t); \
  GLOAM_SH_REST_##order(GLOAM_SH_SCALE)                                                      \
  h[0] = mean * mix(kShExpLinearA##order[below], kShExpLinearA##order[below + 1], t) * kShZonal0;

#define GLOAM_SH_EXP_SERIES(order, size)                               \
  float b = exp(f[0] / kShZonal0);                                     \
  float rest[size], term[size];                                        \
  GLOAM_SH_REST_##order(GLOAM_SH_FIRST_TERM)                           \
  term[0] = 0.0f;                                                      \
  rest[0] = 0.0f;                                                      \
  h[0] = kShZonal0;                                                    \
  for (int n = 2; n <= terms; ++n) {                                   \
    float g[size];                                                     \
    shProduct##order(term, rest, g);                                   \
    GLOAM_SH_NEXT_TERM(0)                                              \
    GLOAM_SH_REST_##order(GLOAM_SH_NEXT_TERM)                          \
  }                                                                    \
  GLOAM_SH_TIMES_B(0)                                                  \
  GLOAM_SH_REST_##order(GLOAM_SH_TIMES_B)

void shExpHybrid3(const float f[9], out float h[9]) { GLOAM_SH_EXP_HYBRID(3, 9) }
void shExpHybrid4(const float f[16], out float h[16]) { GLOAM_SH_EXP_HYBRID(4, 16) }
void shExpQuadratic3(const float f[9], out float h[9]) { GLOAM_SH_EXP_QUADRATIC(3, 9) }
void shExpQuadratic4(const float f[16], out float h[16]) { GLOAM_SH_EXP_QUADRATIC(4, 16) }
void shExpLinear3(const float f[9], out float h[9]) { GLOAM_SH_EXP_LINEAR(3) }
void shExpLinear4(const float f[16], out float h[16]) { GLOAM_SH_EXP_LINEAR(4) }
void shExpSeries3(const float f[9], int terms, out float h[9]) { GLOAM_SH_EXP_SERIES(3, 9) }
void shExpSeries4(const float f[16], int terms, out float h[16]) { GLOAM_SH_EXP_SERIES(4, 16) }

#endif
