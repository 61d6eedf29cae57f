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

// Each band of f times its entry of factors. Written out: loops whose bounds depend on loops are not unrolled by
// drivers, and arrays indexed by them go to memory (twenty times slower on Mesa's software driver).
#define GLOAM_SH_SCALE_BAND_0(f, factors) \
  f[0] *= factors[0];
#define GLOAM_SH_SCALE_BAND_1(f, factors) \
  f[1] *= factors[1]; f[2] *= factors[1]; f[3] *= factors[1];
#define GLOAM_SH_SCALE_BAND_2(f, factors) \
  f[4] *= factors[2]; f[5] *= factors[2]; f[6] *= factors[2]; f[7] *= factors[2]; f[8] *= factors[2];
#define GLOAM_SH_SCALE_BAND_3(f, factors)                                            \
  f[9] *= factors[3]; f[10] *= factors[3]; f[11] *= factors[3]; f[12] *= factors[3]; \
  f[13] *= factors[3]; f[14] *= factors[3]; f[15] *= factors[3];
#define GLOAM_SH_SCALE_BAND_4(f, factors)                                             \
  f[16] *= factors[4]; f[17] *= factors[4]; f[18] *= factors[4]; f[19] *= factors[4]; \
  f[20] *= factors[4]; f[21] *= factors[4]; f[22] *= factors[4]; f[23] *= factors[4]; \
  f[24] *= factors[4];
#define GLOAM_SH_SCALE_BAND_5(f, factors)                                             \
  f[25] *= factors[5]; f[26] *= factors[5]; f[27] *= factors[5]; f[28] *= factors[5]; \
  f[29] *= factors[5]; f[30] *= factors[5]; f[31] *= factors[5]; f[32] *= factors[5]; \
  f[33] *= factors[5]; f[34] *= factors[5]; f[35] *= factors[5];
#define GLOAM_SH_SCALE_BANDS_2(f, factors) GLOAM_SH_SCALE_BAND_0(f, factors) GLOAM_SH_SCALE_BAND_1(f, factors)
#define GLOAM_SH_SCALE_BANDS_3(f, factors) GLOAM_SH_SCALE_BANDS_2(f, factors) GLOAM_SH_SCALE_BAND_2(f, factors)
#define GLOAM_SH_SCALE_BANDS_4(f, factors) GLOAM_SH_SCALE_BANDS_3(f, factors) GLOAM_SH_SCALE_BAND_3(f, factors)
#define GLOAM_SH_SCALE_BANDS_5(f, factors) GLOAM_SH_SCALE_BANDS_4(f, factors) GLOAM_SH_SCALE_BAND_4(f, factors)
#define GLOAM_SH_SCALE_BANDS_6(f, factors) GLOAM_SH_SCALE_BANDS_5(f, factors) GLOAM_SH_SCALE_BAND_5(f, factors)

// SH-4: a zonal function (one coefficient a band) turned to an axis.
#define GLOAM_SH_ROTATE_ZONAL(order, zonal, f)                  \
  GLOAM_SH_SCALE_BANDS_##order(f, zonal)                         \
  GLOAM_SH_SCALE_BANDS_##order(f, kShZonalFactors)

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
void shConvolveCosine3(inout vec3 f[9]) { GLOAM_SH_SCALE_BANDS_3(f, kShClampedCosineFactors) }
void shConvolveCosine4(inout vec3 f[16]) { GLOAM_SH_SCALE_BANDS_4(f, kShClampedCosineFactors) }
void shConvolveCosine5(inout vec3 f[25]) { GLOAM_SH_SCALE_BANDS_5(f, kShClampedCosineFactors) }
void shConvolveCosine6(inout vec3 f[36]) { GLOAM_SH_SCALE_BANDS_6(f, kShClampedCosineFactors) }

// Light convolved with a kernel of these band factors, at a direction.
#define GLOAM_SH_BAND_0(light, y) \
  (light[0] * y[0])
#define GLOAM_SH_BAND_1(light, y) \
  (light[1] * y[1] + light[2] * y[2] + light[3] * y[3])
#define GLOAM_SH_BAND_2(light, y) \
  (light[4] * y[4] + light[5] * y[5] + light[6] * y[6] + light[7] * y[7] + light[8] * y[8])
#define GLOAM_SH_BAND_3(light, y)                                                                  \
  (light[9] * y[9] + light[10] * y[10] + light[11] * y[11] + light[12] * y[12] + light[13] * y[13] \
  + light[14] * y[14] + light[15] * y[15])
#define GLOAM_SH_BAND_4(light, y)                                                                    \
  (light[16] * y[16] + light[17] * y[17] + light[18] * y[18] + light[19] * y[19] + light[20] * y[20] \
  + light[21] * y[21] + light[22] * y[22] + light[23] * y[23] + light[24] * y[24])
#define GLOAM_SH_BAND_5(light, y)                                                                     \
  (light[25] * y[25] + light[26] * y[26] + light[27] * y[27] + light[28] * y[28] + light[29] * y[29]  \
  + light[30] * y[30] + light[31] * y[31] + light[32] * y[32] + light[33] * y[33] + light[34] * y[34] \
  + light[35] * y[35])
#define GLOAM_SH_BANDS_2(light, y, factors) \
  factors[0] * GLOAM_SH_BAND_0(light, y) + factors[1] * GLOAM_SH_BAND_1(light, y)
#define GLOAM_SH_BANDS_3(light, y, factors) \
  GLOAM_SH_BANDS_2(light, y, factors) + factors[2] * GLOAM_SH_BAND_2(light, y)
#define GLOAM_SH_BANDS_4(light, y, factors) \
  GLOAM_SH_BANDS_3(light, y, factors) + factors[3] * GLOAM_SH_BAND_3(light, y)
#define GLOAM_SH_BANDS_5(light, y, factors) \
  GLOAM_SH_BANDS_4(light, y, factors) + factors[4] * GLOAM_SH_BAND_4(light, y)
#define GLOAM_SH_BANDS_6(light, y, factors) \
  GLOAM_SH_BANDS_5(light, y, factors) + factors[5] * GLOAM_SH_BAND_5(light, y)
#define GLOAM_SH_CONVOLVED_VALUE(order, light, y, factors) return GLOAM_SH_BANDS_##order(light, y, factors);

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
