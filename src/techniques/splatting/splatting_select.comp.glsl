// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-9: subsplats for which merged lights are too coarse ask for the next set.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_shared.h"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) buffer CountsBlock { Counts value; } counts;
layout(scalar, set = 0, binding = 1) readonly buffer Light { vec4 at[]; } light;
layout(scalar, set = 0, binding = 2) readonly buffer List { uint at[]; } list;
layout(scalar, set = 0, binding = 3) writeonly buffer NextList { uint at[]; } next_list;
layout(scalar, push_constant) uniform Push { int set; float cluster_threshold; } push;

void main() {
  uint index = uint(kEach) * (gl_WorkGroupID.y * kRowOfGroups * uint(kGroup) + gl_GlobalInvocationID.x);
  for (uint i = index; i < index + uint(kEach) && i < counts.value.listed[push.set]; ++i) {
    vec4 sum = light.at[list.at[i]];
    if (push.cluster_threshold <= 0.0 || sum.a > push.cluster_threshold * (sum.r + sum.g + sum.b))
      next_list.at[atomicAdd(counts.value.listed[push.set - 1], 1u)] = list.at[i];
  }
}
