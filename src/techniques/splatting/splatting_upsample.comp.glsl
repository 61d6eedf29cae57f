// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One level of MS-6: its own light, or that from the next coarser level; and which neighbours go with a texel. An invocation has
// the four children of a coarser texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "techniques/splatting/splatting_ranges.glsl"
#include "techniques/splatting/splatting_shared.h"
#include "techniques/splatting/splatting_upsample.glsl"

layout(constant_id = 0) const bool coarsest = false;
layout(constant_id = 1) const bool along_surfaces = true;

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D own;  // of subsplats; smaller where the level has none
layout(set = 0, binding = 2) uniform usampler2D ranges;
layout(set = 0, binding = 3) uniform writeonly image2D result;
layout(scalar, set = 0, binding = 4) uniform ViewBlock { FrameView view; } frame_view;
layout(scalar, push_constant) uniform Push { Thresholds thresholds; } push;

/// Whether both vary together by no more than two texels of a smooth surface may; facets of what is shaded smoothly go together.
const float kFacets = 0.4;
bool goTogether(Ranges a, Ranges b) {
  Ranges both = joined(a, b);
  return both.near > 0.0 && normalSpan(both) <= max(2.0 * push.thresholds.normal, kFacets) &&
         depthSpan(both, vec2(frame_view.view.depth_range, frame_view.view.z_near)) <= 2.0 * push.thresholds.depth;
}

void main() {
  ivec2 parent = ivec2(gl_GlobalInvocationID.xy), size = imageSize(result), last = size - 1;
  if (any(greaterThanEqual(2 * parent, size))) return;
  vec4 inherited[4] = vec4[4](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  if (!coarsest) fromCoarser(parentsOf(parent), inherited);
  Ranges around[12];  // from the left of the four to their right, and below
  for (int i = 0; i < 12; ++i)
    around[i] = unpackRanges(texelFetch(ranges, clamp(2 * parent + ivec2(i % 4 - 1, i / 4), ivec2(0), last), 0));
  for (int i = 0; i < 4; ++i) {
    ivec2 at = 2 * parent + ivec2(i & 1, i >> 1);
    vec4 value = all(lessThan(at, textureSize(own, 0))) ? texelFetch(own, at, 0) : vec4(0.0);
    if (way == 2) {
      if (value.a < 0.0) value = vec4(0.0);
      if (!coarsest) value = vec4(value.rgb + inherited[i].rgb, 1.0);
    }
    if (!coarsest && value.a == 0.0) value = inherited[i];
    uint bits = 15u;
    if (along_surfaces) {
      int here = (i & 1) + 1 + 4 * (i >> 1);
      bits = (goTogether(around[here], around[here + 1]) ? 1u : 0u) | (goTogether(around[here], around[here + 3]) ? 2u : 0u) |
             (goTogether(around[here], around[here + 4]) ? 4u : 0u) | (goTogether(around[here], around[here + 5]) ? 8u : 0u);
    }
    if (all(lessThan(at, size)))
      imageStore(result, at, value.a != 0.0 ? vec4(value.rgb, sign(value.a) * (1.0 + float(bits))) : vec4(0.0));
  }
}
