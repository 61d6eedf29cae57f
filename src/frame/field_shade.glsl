// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Irradiance of distant light through a visibility O, as a function of the normal: sum of O_i Q_ij y_j(N). Includers declare a uniform
// block `light` whose `row` holds shade[144] (frame/field_shade.h).
#ifndef GLOAM_FRAME_FIELD_SHADE_GLSL
#define GLOAM_FRAME_FIELD_SHADE_GLSL
#include "math/sh.glsl"

#define GLOAM_Q(i, j) light.row.shade[9 * i + j]
/// One term of the irradiance as a function of the normal: sum over i of O_i Q_ij.
#define GLOAM_SHADE(j)                                                                             \
  (o[0] * GLOAM_Q(0, j) + o[1] * GLOAM_Q(1, j) + o[2] * GLOAM_Q(2, j) + o[3] * GLOAM_Q(3, j) +     \
   o[4] * GLOAM_Q(4, j) + o[5] * GLOAM_Q(5, j) + o[6] * GLOAM_Q(6, j) + o[7] * GLOAM_Q(7, j) +     \
   o[8] * GLOAM_Q(8, j) + o[9] * GLOAM_Q(9, j) + o[10] * GLOAM_Q(10, j) + o[11] * GLOAM_Q(11, j) + \
   o[12] * GLOAM_Q(12, j) + o[13] * GLOAM_Q(13, j) + o[14] * GLOAM_Q(14, j) + o[15] * GLOAM_Q(15, j))

/// Irradiance as a function of the normal: sum of t_j y_j(N) = O_p . (L * H(N)).
void shadeTerms(const float o[16], out vec3 t[9]) {
  t[0] = GLOAM_SHADE(0);
  t[1] = GLOAM_SHADE(1);
  t[2] = GLOAM_SHADE(2);
  t[3] = GLOAM_SHADE(3);
  t[4] = GLOAM_SHADE(4);
  t[5] = GLOAM_SHADE(5);
  t[6] = GLOAM_SHADE(6);
  t[7] = GLOAM_SHADE(7);
  t[8] = GLOAM_SHADE(8);
}
vec3 irradianceOf(const vec3 t[9], vec3 normal) {
  float y[9];
  shEvaluate3(normal, y);
  return y[0] * t[0] + y[1] * t[1] + y[2] * t[2] + y[3] * t[3] + y[4] * t[4] + y[5] * t[5] + y[6] * t[6] +
         y[7] * t[7] + y[8] * t[8];
}
/// Ringing may leave it below 0, which counts as 0.
vec3 irradianceThrough(const float o[16], vec3 normal) {
  vec3 t[9];
  shadeTerms(o, t);
  return max(irradianceOf(t, normal), vec3(0.0));
}

#endif
