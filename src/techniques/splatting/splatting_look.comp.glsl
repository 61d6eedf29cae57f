// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Ranges of a level as pictures, to look at: normal, eye depth.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/view.glsl"
#include "techniques/splatting/splatting_ranges.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform usampler2D ranges;
layout(set = 0, binding = 2) uniform writeonly image2D least;
layout(set = 0, binding = 3) uniform writeonly image2D greatest;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(least)))) return;
  Ranges range = unpackRanges(texelFetch(ranges, at, 0));
  bool shows = range.near > 0.0;
  imageStore(least, at, shows ? vec4(range.low, eyeDepth(frame_view.view, range.near)) : vec4(0.0));
  imageStore(greatest, at, shows ? vec4(range.high, eyeDepth(frame_view.view, range.far)) : vec4(0.0));
}
