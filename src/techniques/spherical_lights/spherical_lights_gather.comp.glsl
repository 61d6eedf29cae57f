// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Second pass (SL-4 to SL-6) at each receiver: spheres from the nearest on, each lit by what it sends and blocked by those before it;
// then the environment through all of them. One loop over all spheres, so that the exponential, long code, stands here once.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/spherical_lights/spherical_lights_shared.h"
#define GLOAM_ROW(type) type
#include "techniques/spherical_lights/spherical_lights_second_pass.glsl"

layout(constant_id = 0) const int blocking = 0;
layout(constant_id = 1) const int visibility_kind = 1;

layout(scalar, set = 0, binding = 5) readonly buffer Meets { uint at[]; } meets;

#include "techniques/spherical_lights/spherical_lights_gather.glsl"

void main() {
  ivec2 place = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(place, imageSize(direct)))) return;
  vec4 position = texelFetch(receiver_position, place, 0);
  Gathered got = Gathered(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
  if (position.w > 0.0) got = gather(position.xyz, texelFetch(receiver_normal, place, 0).xyz);
  imageStore(direct, place, vec4(got.direct, 1.0));
  imageStore(indirect, place, vec4(got.indirect, 1.0));
  imageStore(visibility, place, vec4(got.visibility));
  imageStore(unblocked, place, vec4(got.unblocked, 1.0));
}
