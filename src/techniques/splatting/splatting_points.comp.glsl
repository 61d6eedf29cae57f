// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Where the leaves of one level receive: at the mean of their pixels; leaves of the finest level that is allowed, which may hold
// an edge, at the pixel in their middle, else the first that shows a surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "techniques/splatting/splatting_shared.h"

layout(constant_id = 0) const bool at_pixel = false;

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform sampler2D positions;
layout(set = 0, binding = 4) uniform sampler2D shadings;
layout(scalar, set = 0, binding = 5) readonly buffer CountsBlock { Counts value; } counts;
layout(scalar, set = 0, binding = 6) readonly buffer Leaves { uint at[]; } leaves;
layout(scalar, set = 0, binding = 7) writeonly buffer Subsplats { Subsplat at[]; } subsplats;
layout(scalar, push_constant) uniform Push { int level; } push;

void main() {
  uint index = gl_WorkGroupID.y * kRowOfGroups * uint(kGroup) + gl_GlobalInvocationID.x;
  if (index >= counts.value.leaves[push.level]) return;
  uint place = leaves.at[index];
  ivec2 at = ivec2(place & 0xffffu, place >> 16);
  Subsplat subsplat;
  subsplat.place = place;
  subsplat.unused = 0u;
  if (at_pixel) {
    int side = 1 << push.level;
    ivec2 size = textureSize(depth, 0), corner = at * side, pixel = min(corner + side / 2, size - 1);
    float d = texelFetch(depth, pixel, 0).x;
    for (int i = 0; d <= 0.0 && i < side * side; ++i) {
      pixel = min(corner + ivec2(i % side, i / side), size - 1);
      d = texelFetch(depth, pixel, 0).x;
    }
    Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
    subsplat.position = ray.origin + ray.direction * eyeDepth(frame_view.view, max(d, 1e-30));
    subsplat.normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
  } else {
    subsplat.position = texelFetch(positions, at, 0).xyz;
    subsplat.normal = texelFetch(shadings, at, 0).xyz;
  }
  subsplats.at[counts.value.first_leaf[push.level] + index] = subsplat;
}
