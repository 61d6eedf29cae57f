// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_VPLS_WALKS_GLSL
#define GLOAM_VPLS_WALKS_GLSL
#include "math/punctual.glsl"
#include "vpls/walks_shared.h"

/// The cosine at a lit surface's light, `height` above its plane, as if the light came from the nearest place of a disc.
float discCosine(float height, float squared_distance, float bound) {
  float squared_height = height * height;
  float beside = max(squared_distance - squared_height - kDiscReach * bound, 0.0);
  return height * inversesqrt(max(squared_height + beside + kDiscSoftness * bound, kLeastSquaredDistance));
}

/// Irradiance that a virtual light throws, unshadowed, on a plane that faces it (RF-3: Phi_k / pi max(0, N_k . (-w_k)) / d^2, or
/// L_k dw_k), and the unit direction to it.
vec3 walkIrradiance(WalkVpl vpl, vec3 position, out vec3 to_light) {
  to_light = vpl.end.position;
  if (vpl.end.kind == kSightDirectional) return vpl.light;
  vec3 between = vpl.end.position - position;
  float squared = max(dot(between, between), kLeastSquaredDistance);
  float distance = sqrt(squared);
  to_light = between / distance;
  float cosine = -dot(to_light, vpl.end.normal);
  if (vpl.end.kind == kSightLamp)
    return vpl.light * (rangeFactor(distance, vpl.range) * coneFactor(cosine, vpl.cos_inner, vpl.cos_outer) / squared);
  cosine = vpl.end.kind == kSightBothSides ? abs(cosine) : discCosine(max(cosine, 0.0) * distance, squared, vpl.bound);
  return vpl.light * (cosine / max(squared, vpl.bound));
}

#endif
