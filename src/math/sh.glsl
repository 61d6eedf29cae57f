// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Spherical harmonics in shaders: the functions of gloam/sh.h under the same names, one for each order (the digit at
// their end); constants and polynomials are those of the C++ side. The tests also compile this file as C++ and hold it
// against its twins there, hence the C-style initialisers and array parameters.
#ifndef GLOAM_MATH_SH_GLSL
#define GLOAM_MATH_SH_GLSL

#include "math/sh_constants.h"
#include "math/sh_basis.h"

/// sqrt(4 pi / (2 l + 1)) by band, and A_l of the clamped cosine.
const float kShZonalFactors[6] = {kShZonal0, kShZonal1, kShZonal2, kShZonal3, kShZonal4, kShZonal5};
const float kShClampedCosineFactors[6] = {kShCosine0, kShCosine1, kShCosine2, 0.0f, kShCosine4, 0.0f};

// SH-1: all basis functions at a unit vector.
void shEvaluate2(vec3 d, out float y[4]) { GLOAM_SH_BASIS_2(y, d.x, d.y, d.z) }
void shEvaluate3(vec3 d, out float y[9]) { GLOAM_SH_BASIS_3(y, d.x, d.y, d.z) }
void shEvaluate4(vec3 d, out float y[16]) { GLOAM_SH_BASIS_4(y, d.x, d.y, d.z) }
void shEvaluate5(vec3 d, out float y[25]) { GLOAM_SH_BASIS_5(y, d.x, d.y, d.z) }
void shEvaluate6(vec3 d, out float y[36]) { GLOAM_SH_BASIS_6(y, d.x, d.y, d.z) }

// Each band of f times its entry of factors.
#define GLOAM_SH_SCALE_BANDS(order, f, factors)                 \
  for (int l = 0; l < order; ++l) {                             \
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) {           \
      f[i] *= factors[l];                                       \
    }                                                           \
  }

// SH-4: a zonal function (one coefficient a band) turned to an axis.
#define GLOAM_SH_ROTATE_ZONAL(order, zonal, f)                  \
  GLOAM_SH_SCALE_BANDS(order, f, zonal)                         \
  GLOAM_SH_SCALE_BANDS(order, f, kShZonalFactors)

void shRotateZonal2(const float zonal[2], vec3 axis, out float f[4]) {
  shEvaluate2(axis, f);
  GLOAM_SH_ROTATE_ZONAL(2, zonal, f)
}
void shRotateZonal3(const float zonal[3], vec3 axis, out float f[9]) {
  shEvaluate3(axis, f);
  GLOAM_SH_ROTATE_ZONAL(3, zonal, f)
}
void shRotateZonal4(const float zonal[4], vec3 axis, out float f[16]) {
  shEvaluate4(axis, f);
  GLOAM_SH_ROTATE_ZONAL(4, zonal, f)
}
void shRotateZonal5(const float zonal[5], vec3 axis, out float f[25]) {
  shEvaluate5(axis, f);
  GLOAM_SH_ROTATE_ZONAL(5, zonal, f)
}
void shRotateZonal6(const float zonal[6], vec3 axis, out float f[36]) {
  shEvaluate6(axis, f);
  GLOAM_SH_ROTATE_ZONAL(6, zonal, f)
}

// SH-5: convolution with the clamped cosine, in place: light becomes irradiance by normal.
void shConvolveCosine3(inout vec3 f[9]) { GLOAM_SH_SCALE_BANDS(3, f, kShClampedCosineFactors) }
void shConvolveCosine4(inout vec3 f[16]) { GLOAM_SH_SCALE_BANDS(4, f, kShClampedCosineFactors) }
void shConvolveCosine5(inout vec3 f[25]) { GLOAM_SH_SCALE_BANDS(5, f, kShClampedCosineFactors) }
void shConvolveCosine6(inout vec3 f[36]) { GLOAM_SH_SCALE_BANDS(6, f, kShClampedCosineFactors) }

// Light convolved with a kernel of these band factors, at a direction.
#define GLOAM_SH_CONVOLVED_VALUE(order, light, y, factors)      \
  vec3 sum = vec3(0.0f);                                        \
  for (int l = 0; l < order; ++l) {                             \
    vec3 band = vec3(0.0f);                                     \
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) {           \
      band += light[i] * y[i];                                  \
    }                                                           \
    sum += factors[l] * band;                                   \
  }                                                             \
  return sum;

vec3 shConvolvedValue3(const vec3 light[9], vec3 direction, const float factors[6]) {
  float y[9];
  shEvaluate3(direction, y);
  GLOAM_SH_CONVOLVED_VALUE(3, light, y, factors)
}
vec3 shConvolvedValue4(const vec3 light[16], vec3 direction, const float factors[6]) {
  float y[16];
  shEvaluate4(direction, y);
  GLOAM_SH_CONVOLVED_VALUE(4, light, y, factors)
}
vec3 shConvolvedValue5(const vec3 light[25], vec3 direction, const float factors[6]) {
  float y[25];
  shEvaluate5(direction, y);
  GLOAM_SH_CONVOLVED_VALUE(5, light, y, factors)
}
vec3 shConvolvedValue6(const vec3 light[36], vec3 direction, const float factors[6]) {
  float y[36];
  shEvaluate6(direction, y);
  GLOAM_SH_CONVOLVED_VALUE(6, light, y, factors)
}

/// Irradiance of SH light on a plane with that normal.
vec3 shIrradiance3(const vec3 light[9], vec3 n) { return shConvolvedValue3(light, n, kShClampedCosineFactors); }
vec3 shIrradiance4(const vec3 light[16], vec3 n) { return shConvolvedValue4(light, n, kShClampedCosineFactors); }
vec3 shIrradiance5(const vec3 light[25], vec3 n) { return shConvolvedValue5(light, n, kShClampedCosineFactors); }
vec3 shIrradiance6(const vec3 light[36], vec3 n) { return shConvolvedValue6(light, n, kShClampedCosineFactors); }

#endif
