// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-5: what a receiver gets of a virtual light, E = I max(0, N_l.V_ls) max(0, N.V_sl) / max(d^2, b^2), V unit vectors. bound_kind:
// 0 no bound, 1 that one, 2 that of a disc, d^2 + b^2, which is exact on its axis.
#ifndef GLOAM_SPLATTING_LIGHT_GLSL
#define GLOAM_SPLATTING_LIGHT_GLSL
#include "vpls/vpls_shared.h"

layout(constant_id = 10) const int bound_kind = 1;

void addVpl(inout vec3 sum, VplRow vpl, vec3 position, vec3 normal) {
  vec3 between = vpl.position - position;
  float squared = max(dot(between, between), 1e-12);
  float cosines = max(dot(normal, between), 0.0) * max(-dot(vpl.normal, between), 0.0);
  float bounded = bound_kind == 0 ? squared : (bound_kind == 1 ? max(squared, vpl.bound) : squared + vpl.bound);
  sum += vpl.intensity * (cosines / (squared * bounded));
}

/// With the light's change in A: all of it over its distance.
void addVplAndChange(inout vec4 sum, VplRow vpl, vec3 position, vec3 normal) {
  vec3 light = vec3(0.0);
  addVpl(light, vpl, position, normal);
  vec3 between = vpl.position - position;
  sum += vec4(light, (light.r + light.g + light.b) * inversesqrt(max(dot(between, between), 1e-12)));
}

#endif
