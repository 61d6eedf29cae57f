// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-4: texels of one level are kept as subsplats or split in four. Coarsest level: all that show a surface; below it, those that
// wait in its queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "techniques/splatting/splatting_ranges.glsl"
#include "techniques/splatting/splatting_shared.h"

layout(constant_id = 0) const bool coarsest = true;
layout(constant_id = 1) const bool splits = true;          // false: the finest level that is allowed
layout(constant_id = 2) const bool children_are_pixels = false;  // and leaves

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform usampler2D ranges;
#include "techniques/splatting/splatting_children.glsl"
layout(scalar, set = 0, binding = 3) buffer CountsBlock { Counts value; } counts;
layout(scalar, set = 0, binding = 4) readonly buffer Queue { uint at[]; } queue;
layout(scalar, set = 0, binding = 5) writeonly buffer Leaves { uint at[]; } leaves;
layout(scalar, set = 0, binding = 6) writeonly buffer Children { uint at[]; } children;
layout(scalar, set = 0, binding = 7) uniform ViewBlock { FrameView view; } frame_view;
layout(scalar, push_constant) uniform Push { Thresholds thresholds; int level; } push;

void main() {
  uint index = gl_WorkGroupID.y * kRowOfGroups * uint(kGroup) + gl_GlobalInvocationID.x;
  ivec2 size = textureSize(ranges, 0);
  uint count = coarsest ? uint(size.x * size.y) : counts.value.queued[push.level];
  if (index >= count) return;
  uint place = coarsest ? (index % uint(size.x)) | ((index / uint(size.x)) << 16) : queue.at[index];
  ivec2 at = ivec2(place & 0xffffu, place >> 16);
  Ranges range = unpackRanges(texelFetch(ranges, at, 0));
  if (range.near <= 0.0) return;
  // Thresholds of 0 split all.
  bool varies = normalSpan(range) >= push.thresholds.normal ||
                depthSpan(range, vec2(frame_view.view.depth_range, frame_view.view.z_near)) >= push.thresholds.depth;
  if (!splits || !varies) {
    leaves.at[atomicAdd(counts.value.leaves[push.level], 1u)] = place;
    return;
  }
  for (int i = 0; i < 4; ++i) {
    ivec2 child = 2 * at + ivec2(i & 1, i >> 1);
    if (!isCoveredChild(child, children_are_pixels)) continue;
    uint at_child = children_are_pixels ? atomicAdd(counts.value.leaves[0], 1u) : atomicAdd(counts.value.queued[push.level - 1], 1u);
    children.at[at_child] = uint(child.x) | (uint(child.y) << 16);
  }
}
