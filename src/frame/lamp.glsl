// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_FRAME_LAMP_GLSL
#define GLOAM_FRAME_LAMP_GLSL
#include "frame/frame_shared.h"
#include "math/punctual.glsl"

/// Irradiance on a plane that faces the lamp, and the direction to it: intensity * rangeFactor / d^2 * coneFactor.
vec3 lampIrradiance(LightRow row, vec3 position, out vec3 to_light) {
  to_light = -row.direction;
  if (row.kind == kLightDirectional) return row.intensity;
  vec3 between = row.position - position;
  float squared = max(dot(between, between), kLeastSquaredDistance);
  float distance = sqrt(squared);
  to_light = between / distance;
  float factor = rangeFactor(distance, row.range) / squared;
  if (row.kind == kLightSpot)
    factor *= coneFactor(-dot(to_light, row.direction), row.cos_inner, row.cos_outer);
  return row.intensity * factor;
}

#endif
