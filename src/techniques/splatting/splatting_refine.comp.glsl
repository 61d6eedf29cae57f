// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-4: texels of one level are kept as subsplats or split in four. Coarsest level: all that show a surface; below it, those that
// wait in its queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_shared.h"

layout(constant_id = 0) const bool coarsest = true;
layout(constant_id = 1) const bool splits = true;          // false: the finest level that is allowed
layout(constant_id = 2) const bool children_are_pixels = false;  // and leaves

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform sampler2D least;
layout(set = 0, binding = 1) uniform sampler2D greatest;
layout(set = 0, binding = 2) uniform sampler2D child_pixels;  // of children: their positions' w, or the picture's depth
layout(scalar, set = 0, binding = 3) buffer CountsBlock { Counts value; } counts;
layout(scalar, set = 0, binding = 4) readonly buffer Queue { uint at[]; } queue;
layout(scalar, set = 0, binding = 5) writeonly buffer Leaves { uint at[]; } leaves;
layout(scalar, set = 0, binding = 6) writeonly buffer Children { uint at[]; } children;
layout(scalar, push_constant) uniform Push { Thresholds thresholds; int level; } push;

bool isCovered(ivec2 child) {
  if (any(greaterThanEqual(child, textureSize(child_pixels, 0)))) return false;
  vec4 texel = texelFetch(child_pixels, child, 0);
  return (children_are_pixels ? texel.x : texel.w) > 0.0;
}

void main() {
  uint index = gl_WorkGroupID.y * kRowOfGroups * uint(kGroup) + gl_GlobalInvocationID.x;
  ivec2 size = textureSize(least, 0);
  uint count = coarsest ? uint(size.x * size.y) : counts.value.queued[push.level];
  if (index >= count) return;
  uint place = coarsest ? (index % uint(size.x)) | ((index / uint(size.x)) << 16) : queue.at[index];
  ivec2 at = ivec2(place & 0xffffu, place >> 16);
  vec4 low = texelFetch(least, at, 0), high = texelFetch(greatest, at, 0);
  if (high.w < 0.0) return;
  vec4 span = high - low;
  // Thresholds of 0 split all.
  bool varies = max(span.x, max(span.y, span.z)) >= push.thresholds.normal || span.w >= push.thresholds.depth * low.w;
  if (!splits || !varies) {
    leaves.at[atomicAdd(counts.value.leaves[push.level], 1u)] = place;
    return;
  }
  for (int i = 0; i < 4; ++i) {
    ivec2 child = 2 * at + ivec2(i & 1, i >> 1);
    if (!isCovered(child)) continue;
    uint at_child = children_are_pixels ? atomicAdd(counts.value.leaves[0], 1u) : atomicAdd(counts.value.queued[push.level - 1], 1u);
    children.at[at_child] = uint(child.x) | (uint(child.y) << 16);
  }
}
