// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light of an object's probes, blended at a vertex, for matrices.
#ifndef GLOAM_PRT_LOCAL_GLOSS_GLSL
#define GLOAM_PRT_LOCAL_GLOSS_GLSL

layout(scalar, push_constant) uniform Push { uint block_count; uint light_stride; } push;
layout(constant_id = 5) const int points = 4;
layout(constant_id = 6) const int probe_coefficients = 25;
layout(constant_id = 7) const bool lamps_direct = false;  // else they are left to the shadow maps
layout(scalar, set = 0, binding = 5) readonly buffer ProbeLights { ProbeLight at[]; } probe_lights;
layout(scalar, set = 0, binding = 6) readonly buffer Places { vec3 at[]; } probe_places;
layout(scalar, set = 0, binding = 7) readonly buffer Trust { float at[]; } trust;
layout(scalar, set = 0, binding = 8) readonly buffer Positions { vec3 at[]; } positions;
#include "techniques/prt/prt_local.glsl"
layout(scalar, set = 0, binding = 9) readonly buffer Rows { LocalRow at[]; } rows;
layout(scalar, set = 0, binding = 10) readonly buffer LampLights { vec3 at[]; } lamp_lights;
vec3 light_reflected[36], light_all[36];

ProbeLight blended(uint first_job, int i, float weights[kMostLocalPoints], out vec3 all) {
  ProbeLight light = ProbeLight(vec3(0.0), vec3(0.0));
  vec3 lamps = vec3(0.0);
  for (int k = 0; k < points; ++k) {
    uint at = (first_job + uint(k)) * uint(probe_coefficients) + uint(i);
    ProbeLight of_probe = probe_lights.at[at];
    light.direct += weights[k] * of_probe.direct;
    light.reflected += weights[k] * of_probe.reflected;
    lamps += weights[k] * lamp_lights.at[at];
  }
  all = light.direct + light.reflected + lamps;
  if (lamps_direct) light.direct += lamps;
  return light;
}

#endif
