// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sums over the proxies that reach a receiver's tile: log visibility (a layer four coefficients), indirect irradiance before
// normalisation and, in A, solid angles.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "techniques/proxies/proxies_shared.h"

layout(constant_id = 0) const int indirect_kind = 2;
layout(constant_id = 1) const int exponential = 3;
layout(constant_id = 2) const bool by_lanes = false;

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D receiver_position;
layout(set = 0, binding = 1) uniform sampler2D receiver_normal;
layout(scalar, set = 0, binding = 2) readonly buffer Proxies {
  uint at[];  // of ProxyRows
}
proxies;
layout(scalar, set = 0, binding = 3) readonly buffer Bits {
  uint at[];
}
bits;
layout(scalar, set = 0, binding = 4) readonly buffer LogTable {
  vec4 at[];
}
log_table;
layout(scalar, set = 0, binding = 5) readonly buffer OperatorTable {
  vec4 at[];
}
operator_table;
layout(scalar, set = 0, binding = 9) readonly buffer AloneTable {
  float at[];
}
alone_table;
layout(scalar, set = 0, binding = 6) uniform LightBlock {
  ProxyLight row;
}
light;
layout(set = 0, binding = 7) uniform writeonly image2DArray log_visibility;
layout(set = 0, binding = 8) uniform writeonly image2D indirect;
layout(scalar, push_constant) uniform Push {
  AccumulateParams params;
}
push;

#include "techniques/proxies/proxies_tile_list.glsl"

void main() {
  ivec2 here = ivec2(gl_GlobalInvocationID.xy), place = min(here, imageSize(indirect) - 1);  // all lanes run
  vec4 position = texelFetch(receiver_position, place, 0);
  vec3 normal = texelFetch(receiver_normal, place, 0).xyz;
  uint first = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * push.params.words;
  Gathered sum = gatherTile(position.xyz, normal, first);
  if (here != place) return;
  imageStore(log_visibility, ivec3(place, 0), sum.log0);
  imageStore(log_visibility, ivec3(place, 1), sum.log1);
  imageStore(log_visibility, ivec3(place, 2), sum.log2);
  imageStore(log_visibility, ivec3(place, 3), sum.log3);
  imageStore(indirect, place, sum.sent);
}
