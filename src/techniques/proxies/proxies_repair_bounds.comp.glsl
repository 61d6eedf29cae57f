// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The box round the pixels of each tile that are computed from scratch, so that they too meet only the proxies that reach them.
// Kept as greatest coordinates and greatest negated ones, as numbers that order like them; 0: nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "techniques/proxies/proxies_shared.h"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform usampler2D normals;
layout(scalar, set = 0, binding = 2) readonly buffer Repairs { QuadList list; uint at[]; } repairs;
layout(scalar, set = 0, binding = 3) buffer Bounds { uint at[]; } bounds;
layout(scalar, push_constant) uniform Push { uint columns; uint capacity; uint divisor; } push;

#include "techniques/proxies/proxies_quads.glsl"

uint ordered(float value) {
  uint word = floatBitsToUint(value);
  return (word & 0x80000000u) != 0u ? ~word : word | 0x80000000u;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= min(repairs.list.count_and_one - 1u, push.capacity)) return;
  ivec2 from = firstPixel(repairs.at[i], push.divisor);
  vec3 p = middleOf(repairs.at[i], from).position;
  uint first = 6u * tileOf(from, push.columns);
  atomicMax(bounds.at[first], ordered(p.x));
  atomicMax(bounds.at[first + 1u], ordered(p.y));
  atomicMax(bounds.at[first + 2u], ordered(p.z));
  atomicMax(bounds.at[first + 3u], ordered(-p.x));
  atomicMax(bounds.at[first + 4u], ordered(-p.y));
  atomicMax(bounds.at[first + 5u], ordered(-p.z));
}
