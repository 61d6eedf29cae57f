// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The functions of spheres/receiver_rule.h under the same names.
#ifndef GLOAM_SPHERES_RECEIVER_RULE_GLSL
#define GLOAM_SPHERES_RECEIVER_RULE_GLSL

struct SeenSphere {
  float sin_half_angle;
  vec3 direction;
};

const float kLeastBulge = 0.08f, kMostBulge = 0.5f, kFull = 0.32f;

SeenSphere seenSphere(vec3 receiver, vec3 normal, vec3 center, float radius, float bulge) {
  SeenSphere seen;
  seen.sin_half_angle = 0.0f;
  seen.direction = normal;
  vec3 d = center - receiver;
  float height = dot(d, normal);
  if (height + radius <= 0.0f || radius <= 0.0f) return seen;
  if (height >= radius) {
    float dist = length(d);
    seen.sin_half_angle = min(radius / dist, 1.0f);
    seen.direction = d / dist;
    return seen;
  }
  float nothing = clamp(bulge, kLeastBulge, kMostBulge);
  float standing = 0.5f * (height + radius) * smoothstep(nothing, nothing + kFull, 0.5f * (height + radius) / radius);
  if (standing <= 0.0f) return seen;
  vec3 along = d - height * normal;
  float held2 = max(dot(along, along), radius * radius - height * height);
  vec3 to_standing = along + standing * normal;
  float len = length(to_standing);
  seen.sin_half_angle = standing / sqrt(held2 + standing * standing);
  if (len > 0.0f) seen.direction = to_standing / len;
  return seen;
}

#endif
