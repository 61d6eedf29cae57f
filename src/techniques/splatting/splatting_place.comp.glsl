// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light of one level's subsplats into that level of the buffer, or at last into the picture. That of texels which were split after
// all serves their neighbours' interpolation alone.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "techniques/splatting/splatting_detail.glsl"
#include "techniques/splatting/splatting_shared.h"

layout(constant_id = 0) const bool paints_levels = false;  // to look at

/// A colour a level, from pixels (white) to coarse ones.
const vec3 kColors[8] = vec3[8](vec3(0.9), vec3(0.9, 0.2, 0.15), vec3(0.95, 0.6, 0.1), vec3(0.75, 0.8, 0.15), vec3(0.15, 0.7, 0.3),
                                vec3(0.1, 0.6, 0.75), vec3(0.15, 0.25, 0.8), vec3(0.5, 0.15, 0.7));

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer CountsBlock { Counts value; } counts;
layout(scalar, set = 0, binding = 1) readonly buffer Leaves { uint at[]; } leaves;
layout(scalar, set = 0, binding = 2) readonly buffer Light { vec4 at[]; } light;
layout(set = 0, binding = 3) uniform writeonly image2D level_light;  // A: 1, or -1 where it was split
layout(scalar, set = 0, binding = 4) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 5) uniform usampler2D normals;
layout(scalar, push_constant) uniform Push { int level; } push;

void main() {
  uint index = gl_WorkGroupID.y * kRowOfGroups * uint(kGroup) + gl_GlobalInvocationID.x;
  if (index >= counts.value.leaves[push.level]) return;
  uint place = leaves.at[index];
  ivec2 at = ivec2(place & 0xffffu, (place & ~kSplit) >> 16);
  vec3 irradiance = light.at[counts.value.first_leaf[push.level] + index].rgb;
  if (paints_levels) irradiance = kColors[min(push.level, 7)];
  if (detail > 0.0) irradiance *= detailFactor(frame_view.view, at, texelFetch(normals, at, 0).xy);
  imageStore(level_light, at, vec4(irradiance, (place & kSplit) != 0u ? -1.0 : 1.0));
}
