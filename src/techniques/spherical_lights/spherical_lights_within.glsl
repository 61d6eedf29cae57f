// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What stands before a sphere within its own object. Includers declare ballAt, the buffer listed, and the uniform block light.
#ifndef GLOAM_SPHERICAL_LIGHTS_WITHIN_GLSL
#define GLOAM_SPHERICAL_LIGHTS_WITHIN_GLSL
#include "techniques/spherical_lights/spherical_lights_blockers.glsl"

/// Mean over a disc of the logs of those of its list that stand before it; `bands`: of a mean over the disc.
float logListed(vec3 position, vec3 normal, uint i, Ball ball, vec3 direction, vec4 bands) {
  float sum = 0.0;
  vec3 to_i = ball.center - position;
  float own = dot(to_i, to_i);
  uint first = ball.first_listed, end = first + ball.listed;
  for (uint k = first; k < end; ++k) {
    uint j = listed.at[k];
    Ball other = ballAt(j);
    vec3 to_j = other.center - position;
    float far = dot(to_j, to_j);
    bool nearer = far < own || (far == own && j < i);
    SeenSphere seen = seenSphere(position, normal, other.center, other.radius, other.bulge);
    float log_there = dot(logWeights(seen.sin_half_angle), bands * zonalAt(dot(seen.direction, direction)));
    sum += nearer ? log_there : 0.0;
  }
  return sum;
}

#endif
