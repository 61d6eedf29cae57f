// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-10: leaves of a level whose light changes too much across them are split after all. The measure is that of irradiance
// caching (Ward, Rubinstein, Clear 1988): the texel's size on its surface over the harmonic mean distance of its light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/view.glsl"
#include "techniques/splatting/splatting_shared.h"

/// A surface seen at a slant is longer by the inverse of this at most.
const float kLeastCosine = 0.25;

layout(constant_id = 0) const bool children_are_pixels = false;

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D child_pixels;  // of children: their positions' w, or the picture's depth
layout(scalar, set = 0, binding = 2) buffer CountsBlock { Counts value; } counts;
layout(scalar, set = 0, binding = 3) readonly buffer Subsplats { Subsplat at[]; } subsplats;
layout(scalar, set = 0, binding = 4) readonly buffer Light { vec4 at[]; } light;
layout(scalar, set = 0, binding = 5) buffer Leaves { uint at[]; } leaves;
layout(scalar, set = 0, binding = 6) buffer Children { uint at[]; } children;
layout(scalar, push_constant) uniform Push { LevelPush value; } push;

bool isCovered(ivec2 child) {
  if (any(greaterThanEqual(child, textureSize(child_pixels, 0)))) return false;
  vec4 texel = texelFetch(child_pixels, child, 0);
  return (children_are_pixels ? texel.x : texel.w) > 0.0;
}

void main() {
  int level = push.value.level;
  uint index = gl_WorkGroupID.y * kRowOfGroups * uint(kGroup) + gl_GlobalInvocationID.x;
  if (index >= counts.value.leaves[level]) return;
  uint subsplat = counts.value.first_leaf[level] + index;
  vec3 position = subsplats.at[subsplat].position;
  vec4 sum = light.at[subsplat];
  FrameView view = frame_view.view;
  float along = view.depth_range > 0.0 ? 1.0 : dot(position - view.eye, view.forward);
  float cosine = max(dot(normalize(subsplats.at[subsplat].normal), directionToEye(view, position)), kLeastCosine);
  float side = float(1 << level) * max(length(view.step_x), length(view.step_y)) * along / cosine;
  if (side * sum.a <= push.value.threshold * (sum.r + sum.g + sum.b)) return;
  ivec2 at = ivec2(leaves.at[index] & 0xffffu, leaves.at[index] >> 16);
  for (int i = 0; i < 4; ++i) {
    ivec2 child = 2 * at + ivec2(i & 1, i >> 1);
    if (isCovered(child)) children.at[atomicAdd(counts.value.leaves[level - 1], 1u)] = uint(child.x) | (uint(child.y) << 16);
  }
  leaves.at[index] |= kSplit;
}
