// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-5: what a receiver gets of a virtual light, E = I max(0, N_l.V_ls) max(0, N.V_sl) / max(d^2, b^2), V unit vectors. bound_kind:
// 0 no bound, 1 that one, 2 that of a disc, d^2 + b^2, which is exact on its axis.
#ifndef GLOAM_SPLATTING_LIGHT_GLSL
#define GLOAM_SPLATTING_LIGHT_GLSL
#include "techniques/splatting/splatting_shared.h"
#include "vpls/vpls_shared.h"

layout(constant_id = 10) const int bound_kind = 1;

void addVpl(inout vec3 sum, VplRow vpl, vec3 position, vec3 normal) {
  vec3 between = vpl.position - position;
  float squared = max(dot(between, between), 1e-12);
  float cosines = max(dot(normal, between), 0.0) * max(-dot(vpl.normal, between), 0.0);
  float bounded = bound_kind == 0 ? squared : (bound_kind == 1 ? max(squared, vpl.bound) : squared + vpl.bound);
  sum += vpl.intensity * (cosines / (squared * bounded));
}

/// Four receivers and what they got: what a light is is read once for all, which makes drivers of processors several times faster.
struct Receivers {
  vec4 x, y, z, normal_x, normal_y, normal_z;
};
struct Gathered {
  vec4 red, green, blue;
  vec4 change;  // all light over its squared distance
  vec4 error;   // what merging may have changed of it: its part of the variance of merged lights over squared distance
};

void addLight(inout Gathered sum, SplatLight light, Receivers at, vec4 visible, bool measures, bool merged) {
  vec4 x = light.position.x - at.x, y = light.position.y - at.y, z = light.position.z - at.z;
  vec4 squared = max(x * x + y * y + z * z, 1e-12);
  vec4 inverse = 1.0 / squared;
  vec4 here = at.normal_x * x + at.normal_y * y + at.normal_z * z;
  vec4 there = -(light.normal.x * x + light.normal.y * y + light.normal.z * z);
  vec4 cosines = max(here, 0.0) * max(there, 0.0);
  vec4 bounded = inverse;
  if (bound_kind == 1) bounded = min(inverse, 1.0 / max(light.bound, 1e-20));
  if (bound_kind == 2) bounded = 1.0 / (squared + light.bound);
  vec4 weight = cosines * inverse * bounded * visible;
  sum.red += light.intensity.r * weight;
  sum.green += light.intensity.g * weight;
  sum.blue += light.intensity.b * weight;
  vec4 power = light.power * weight;
  if (merged) {
    vec4 spread = min(light.spread * light.spread * inverse, 1.0);
    // Where their mean is behind the receiver, or it behind theirs, some of them may not be.
    vec4 missed = 0.5 * (max(here, 0.0) * max(there + light.spread, 0.0) + max(there, 0.0) * max(here + light.spread, 0.0));
    missed = mix(missed, vec4(0.0), greaterThan(cosines, vec4(0.0)));
    sum.error += (power + light.power * missed * inverse * bounded * visible) * spread;
    power += 6.0 * power * spread;  // some of them are nearer than their mean
  }
  if (measures) sum.change += power * inverse;
}

#endif
