// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Lights that send something, in their order, without gaps.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "vpls/vpls_shared.h"

const uint kLanes = 256u;

layout(local_size_x = 256) in;
layout(scalar, set = 0, binding = 0) readonly buffer Drawn { VplRow at[]; } drawn;
layout(scalar, set = 0, binding = 1) buffer Rows { VplRow at[]; } rows;
layout(scalar, set = 0, binding = 2) writeonly buffer Count { uint value; } count;
layout(scalar, push_constant) uniform Push { uint drawn_count; } push;

shared uint counts[256];

bool sends(uint i) {
  vec3 intensity = drawn.at[i].intensity;
  return intensity.r + intensity.g + intensity.b > 0.0;
}

void main() {
  uint lane = gl_LocalInvocationID.x;
  uint each = (push.drawn_count + kLanes - 1u) / kLanes;
  uint from = min(lane * each, push.drawn_count), to = min(from + each, push.drawn_count);
  uint own = 0u;
  for (uint i = from; i < to; ++i) own += sends(i) ? 1u : 0u;
  counts[lane] = own;
  barrier();
  uint at = 0u;
  for (uint i = 0u; i < lane; ++i) at += counts[i];
  for (uint i = from; i < to; ++i) {
    if (sends(i)) rows.at[at++] = drawn.at[i];
  }
  if (lane == kLanes - 1u) count.value = at;
}
