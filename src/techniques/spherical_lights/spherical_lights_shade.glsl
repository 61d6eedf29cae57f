// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light of the environment through a visibility, at a receiver: sum of O_i Q_ij y_j(N). Includers declare the uniform block light.
#ifndef GLOAM_SPHERICAL_LIGHTS_SHADE_GLSL
#define GLOAM_SPHERICAL_LIGHTS_SHADE_GLSL
#include "math/sh.glsl"

#define GLOAM_Q(i) (light.rows.shade[9 * i] * y[0] + light.rows.shade[9 * i + 1] * y[1] + \
  light.rows.shade[9 * i + 2] * y[2] + light.rows.shade[9 * i + 3] * y[3] +               \
  light.rows.shade[9 * i + 4] * y[4] + light.rows.shade[9 * i + 5] * y[5] +               \
  light.rows.shade[9 * i + 6] * y[6] + light.rows.shade[9 * i + 7] * y[7] + light.rows.shade[9 * i + 8] * y[8])

/// Ringing may leave it below 0, which counts as 0.
vec3 irradianceThrough(const float o[16], vec3 normal) {
  float y[9];
  shEvaluate3(normal, y);
  vec3 sum = o[0] * GLOAM_Q(0) + o[1] * GLOAM_Q(1) + o[2] * GLOAM_Q(2) + o[3] * GLOAM_Q(3) + o[4] * GLOAM_Q(4);
  sum += o[5] * GLOAM_Q(5) + o[6] * GLOAM_Q(6) + o[7] * GLOAM_Q(7) + o[8] * GLOAM_Q(8) + o[9] * GLOAM_Q(9);
  sum += o[10] * GLOAM_Q(10) + o[11] * GLOAM_Q(11) + o[12] * GLOAM_Q(12) + o[13] * GLOAM_Q(13);
  return max(sum + o[14] * GLOAM_Q(14) + o[15] * GLOAM_Q(15), vec3(0.0));
}

#endif
