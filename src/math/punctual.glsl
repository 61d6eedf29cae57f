// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The functions of math/punctual.h.
#ifndef GLOAM_MATH_PUNCTUAL_GLSL
#define GLOAM_MATH_PUNCTUAL_GLSL

const float kLeastSquaredDistance = 1e-8;

float rangeFactor(float distance, float range) {
  if (range <= 0.0) return 1.0;
  float ratio = distance / range;
  return clamp(1.0 - ratio * ratio * ratio * ratio, 0.0, 1.0);
}

float coneFactor(float cos_angle, float cos_inner, float cos_outer) {
  float ramp = clamp((cos_angle - cos_outer) / max(1e-3, cos_inner - cos_outer), 0.0, 1.0);
  return ramp * ramp;
}

#endif
