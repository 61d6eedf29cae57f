// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Second pass (SL-4 to SL-6) at each receiver, the quick way.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(constant_id = 2) const bool has_indirect = true;
layout(constant_id = 3) const bool glows = false;

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D receiver_position;
layout(set = 0, binding = 1) uniform sampler2D receiver_normal;
layout(scalar, set = 0, binding = 2) readonly buffer Spheres { SphereRow at[]; } spheres;
layout(scalar, set = 0, binding = 3) readonly buffer Objects { ObjectRow at[]; } objects;
layout(scalar, set = 0, binding = 4) readonly buffer Sent { SentRow at[]; } sent;
layout(scalar, set = 0, binding = 13) readonly buffer Glow { SentRow at[]; } glow;
layout(scalar, set = 0, binding = 5) readonly buffer Apart { uint at[]; } apart;
layout(scalar, set = 0, binding = 8) uniform LightBlock { LightRows rows; } light;
layout(set = 0, binding = 9) uniform writeonly image2D direct;
layout(set = 0, binding = 10) uniform writeonly image2D indirect;
layout(set = 0, binding = 11) uniform writeonly image2D visibility;
layout(set = 0, binding = 12) uniform writeonly image2D unblocked;
layout(scalar, set = 0, binding = 20) readonly buffer BlockingPatches { PatchRow at[]; } blocking_patches;
layout(scalar, set = 0, binding = 21) readonly buffer SendingPatches { PatchRow at[]; } sending_patches;
layout(scalar, set = 0, binding = 22) readonly buffer PatchRadiance { vec3 at[]; } patch_radiance;
layout(scalar, push_constant) uniform Push { GatherParams params; } push;

#include "techniques/spherical_lights/spherical_lights_receive.glsl"

void main() {
  ivec2 place = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(place, imageSize(direct)))) return;
  vec4 position = texelFetch(receiver_position, place, 0);
  Gathered got = Gathered(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
  if (position.w > 0.0) got = receive(position.xyz, texelFetch(receiver_normal, place, 0).xyz);
  imageStore(direct, place, vec4(got.direct, 1.0));
  imageStore(indirect, place, vec4(got.indirect, 1.0));
  imageStore(visibility, place, vec4(got.visibility));
  imageStore(unblocked, place, vec4(got.unblocked, 1.0));
}
