// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Second pass (SL-4 to SL-6) at each receiver, the quick way.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/spherical_lights/spherical_lights_shared.h"
#define GLOAM_ROW(type) uint
#include "techniques/spherical_lights/spherical_lights_second_pass.glsl"

layout(constant_id = 0) const int blocking = 0;
layout(constant_id = 1) const uint most_groups = 32u;
layout(constant_id = 4) const bool hierarchy = false;
layout(constant_id = 5) const bool by_lanes = false;

layout(scalar, set = 0, binding = 5) readonly buffer Listed { uint at[]; } listed;
layout(scalar, set = 0, binding = 6) readonly buffer Cuts { LevelRow at[]; } cuts;
layout(scalar, set = 0, binding = 7) readonly buffer Ratios { vec4 at[]; } ratios;

#include "techniques/spherical_lights/spherical_lights_receive.glsl"

void main() {
  // All lanes go on where one does: rows are read together.
  ivec2 place = ivec2(gl_GlobalInvocationID.xy), size = imageSize(direct), from = min(place, size - 1);
  bool inside = all(lessThan(place, size));
  vec4 position = texelFetch(receiver_position, from, 0);
  bool receives = inside && position.w > 0.0;
  const Gathered nothing = Gathered(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
  Gathered got = nothing;
  // A loop, as the software driver runs through both sides of a branch.
  for (uint k = subgroupAny(receives) ? 0u : 1u; k < 1u; ++k)
    got = receive(position.xyz, texelFetch(receiver_normal, from, 0).xyz);
  if (!inside) return;
  if (!receives) got = nothing;
  imageStore(direct, place, vec4(got.direct, 1.0));
  imageStore(indirect, place, vec4(got.indirect, 1.0));
  imageStore(visibility, place, vec4(got.visibility));
  imageStore(unblocked, place, vec4(got.unblocked, 1.0));
}
