// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What stands before a sphere within its own object. Includers declare the buffers spheres and listed, and the uniform block light.
#ifndef GLOAM_SPHERICAL_LIGHTS_WITHIN_GLSL
#define GLOAM_SPHERICAL_LIGHTS_WITHIN_GLSL
#include "techniques/spherical_lights/spherical_lights_blockers.glsl"

/// Mean over a disc of the logs of those of its list that stand before it; `bands`: of a mean over the disc.
float logListed(vec3 position, vec3 normal, uint i, vec3 direction, vec4 bands) {
  float sum = 0.0;
  vec3 to_i = spheres.at[i].center - position;
  float own = dot(to_i, to_i);
  uint first = spheres.at[i].first_listed, end = first + spheres.at[i].listed;
  for (uint k = first; k < end; ++k) {
    uint j = listed.at[k];
    vec3 to_j = spheres.at[j].center - position;
    float far = dot(to_j, to_j);
    bool nearer = far < own || (far == own && j < i);
    SeenSphere seen = seenSphere(position, normal, spheres.at[j].center, spheres.at[j].radius);
    float log_there = dot(logWeights(seen.sin_half_angle), bands * zonalAt(dot(seen.direction, direction)));
    sum += nearer ? log_there : 0.0;
  }
  return sum;
}

#endif
