// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The box round the pixels of each tile that are computed from scratch, so that they too meet only the proxies that reach them.
// Kept as greatest coordinates and greatest negated ones, as numbers that order like them; 0: nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/view.glsl"
#include "techniques/proxies/proxies_shared.h"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(scalar, set = 0, binding = 2) readonly buffer Repairs { RepairList list; uint at[]; } repairs;
layout(scalar, set = 0, binding = 3) buffer Bounds { uint at[]; } bounds;
layout(scalar, push_constant) uniform Push { uint columns; uint capacity; } push;

uint ordered(float value) {
  uint word = floatBitsToUint(value);
  return (word & 0x80000000u) != 0u ? ~word : word | 0x80000000u;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= min(repairs.list.count_and_one - 1u, push.capacity)) return;
  uvec2 pixel = uvec2(repairs.at[i] & 0xffffu, repairs.at[i] >> 16);
  Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
  vec3 p = ray.origin + ray.direction * eyeDepth(frame_view.view, texelFetch(depth, ivec2(pixel), 0).x);
  uint first = 6u * (pixel.y / kRepairTile * push.columns + pixel.x / kRepairTile);
  atomicMax(bounds.at[first], ordered(p.x));
  atomicMax(bounds.at[first + 1u], ordered(p.y));
  atomicMax(bounds.at[first + 2u], ordered(p.z));
  atomicMax(bounds.at[first + 3u], ordered(-p.x));
  atomicMax(bounds.at[first + 4u], ordered(-p.y));
  atomicMax(bounds.at[first + 5u], ordered(-p.z));
}
