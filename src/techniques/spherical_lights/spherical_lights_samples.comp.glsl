// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// First pass (SL-3, SL-9): light of the environment, and of spheres that glow, at each surface sample, all spheres as blockers; what a
// white surface sends.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(constant_id = 0) const int blocking = 0;
layout(constant_id = 1) const int visibility_kind = 1;
layout(constant_id = 2) const bool glows = false;
const bool has_indirect = false;

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer Points { PointRow at[]; } points;
layout(scalar, set = 0, binding = 1) readonly buffer Spheres { SphereRow at[]; } spheres;
layout(scalar, set = 0, binding = 2) readonly buffer Objects { ObjectRow at[]; } objects;
layout(scalar, set = 0, binding = 3) readonly buffer Sent { SentRow at[]; } sent;
layout(scalar, set = 0, binding = 4) readonly buffer Glow { SentRow at[]; } glow;
layout(scalar, set = 0, binding = 5) readonly buffer Meets { uint at[]; } meets;
layout(scalar, set = 0, binding = 8) uniform LightBlock { LightRows row; } light;
layout(scalar, set = 0, binding = 9) writeonly buffer Arriving { vec3 at[]; } arriving;
layout(scalar, set = 0, binding = 20) readonly buffer BlockingPatches { PatchRow at[]; } blocking_patches;
layout(scalar, set = 0, binding = 21) readonly buffer SendingPatches { PatchRow at[]; } sending_patches;
layout(scalar, set = 0, binding = 22) readonly buffer PatchRadiance { vec3 at[]; } patch_radiance;
layout(scalar, push_constant) uniform Push { GatherParams params; uint points; } push;

#include "techniques/spherical_lights/spherical_lights_gather.glsl"

/// The environment alone asks for no order.
vec3 throughAll(vec3 position, vec3 normal) {
  Sh4 whole, logs = logOfPatches(position, normal, whole);
  for (uint j = 0u; j < push.params.spheres; ++j) logs = plus(logs, logOf(position, normal, j));
  float o[16];
  shExpQuadratic4(GLOAM_ARRAY_OF(logs), o);
  return litThrough(o, normal) * skyLeft(position, normal);
}

void main() {
  uint p = gl_GlobalInvocationID.x;
  if (p >= push.points) return;
  PointRow point = points.at[p];
  vec3 lit = vec3(0.0);
  if (point.sends > 0.0) {
    if (glows) lit = gather(point.position, point.normal).direct; else lit = throughAll(point.position, point.normal);
  }
  arriving.at[p] = lit / 3.14159265;
}
