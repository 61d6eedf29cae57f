// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// To look at: samples of the first pass as dots on their surfaces, in the light that they have; or spheres, in what they send from
// each of their points, or on the average toward the eye. All else is grey.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(constant_id = 0) const int what = 0;
layout(constant_id = 1) const bool glows = false;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(scalar, set = 0, binding = 3) readonly buffer Points { PointRow at[]; } points;
layout(scalar, set = 0, binding = 4) readonly buffer Arriving { vec3 at[]; } arriving;
layout(scalar, set = 0, binding = 5) readonly buffer Spheres { SphereRow at[]; } spheres;
layout(scalar, set = 0, binding = 6) readonly buffer Sent { SentRow at[]; } sent;
layout(scalar, set = 0, binding = 7) readonly buffer Glow { SentRow at[]; } glow;
layout(scalar, set = 0, binding = 8) uniform LightBlock { LightRows row; } light;
layout(set = 0, binding = 9) uniform writeonly image2D view;
layout(scalar, push_constant) uniform Push { uint spheres; } push;

#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "techniques/spherical_lights/spherical_lights_blockers.glsl"
#include "techniques/spherical_lights/spherical_lights_radiance.glsl"

const float kDot = 0.07;  // radii of its sphere

vec3 sentBy(uint i, Sh4 f) {
  vec3 radiance = GLOAM_RADIANCE(sent.at[i]);
  if (glows) radiance += GLOAM_RADIANCE(glow.at[i]);
  return radiance;
}

/// The first sphere along a ray of unit direction from the eye.
vec3 spheresAlong(vec3 origin, vec3 direction, vec3 behind) {
  float nearest = 3e38;
  uint found = push.spheres;
  for (uint i = 0u; i < push.spheres; ++i) {
    vec3 to = spheres.at[i].center - origin;
    float along = dot(to, direction), off2 = dot(to, to) - along * along, r2 = spheres.at[i].radius * spheres.at[i].radius;
    float first = along - sqrt(max(r2 - off2, 0.0));
    if (off2 < r2 && first > 0.0 && first < nearest) {
      nearest = first;
      found = i;
    }
  }
  if (found == push.spheres) return behind;
  if (what == kViewEmission) {
    vec3 outward = (origin + nearest * direction - spheres.at[found].center) / spheres.at[found].radius;
    return sentBy(found, basisAt(outward));
  }
  vec3 to = spheres.at[found].center - origin;
  float far = length(to);
  return sentBy(found, averageAt(min(spheres.at[found].radius / far, 1.0), basisAt(to / far)));
}

vec3 samplesAt(vec3 position, vec3 otherwise) {
  vec3 shown = otherwise;
  float nearest = 3e38;
  for (uint i = 0u; i < push.spheres; ++i) {
    vec3 to = spheres.at[i].center - position;
    if (dot(to, to) > 4.0 * spheres.at[i].radius * spheres.at[i].radius) continue;  // samples may lie outside
    float within = kDot * spheres.at[i].radius;
    for (uint p = i * kDirections; p < (i + 1u) * kDirections; ++p) {
      vec3 away = points.at[p].position - position;
      float far = dot(away, away);
      if (points.at[p].sends == 0.0 || far > within * within || far > nearest) continue;
      nearest = far;
      shown = arriving.at[p];
    }
  }
  return shown;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(view)))) return;
  float value = texelFetch(depth, pixel, 0).x;
  Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
  vec3 shown = vec3(0.0), toward = normalize(ray.direction);
  if (value > 0.0) {
    vec3 normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
    shown = vec3(0.02 + 0.06 * max(0.0, -dot(normal, toward)));
    if (what == kViewSamples) shown = samplesAt(ray.origin + eyeDepth(frame_view.view, value) * ray.direction, shown);
  }
  if (what != kViewSamples) shown = spheresAlong(ray.origin, toward, shown);
  imageStore(view, pixel, vec4(shown, 1.0));
}
