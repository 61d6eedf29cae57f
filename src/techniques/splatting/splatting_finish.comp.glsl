// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The last level of MS-6, pixels, four an invocation; and MS-7.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "techniques/splatting/splatting_detail.glsl"
#include "techniques/splatting/splatting_upsample.glsl"

layout(constant_id = 0) const bool has_own = true;  // else light of pixels comes into the result afterwards

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D own;
layout(scalar, set = 0, binding = 2) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 3) uniform usampler2D normals;
layout(set = 0, binding = 4) uniform writeonly image2D result;

void main() {
  ivec2 parent = ivec2(gl_GlobalInvocationID.xy), size = imageSize(result);
  if (any(greaterThanEqual(2 * parent, size))) return;
  vec4 inherited[4];
  fromCoarser(parentsOf(parent), inherited);
  for (int i = 0; i < 4; ++i) {
    ivec2 at = 2 * parent + ivec2(i & 1, i >> 1);
    if (any(greaterThanEqual(at, size))) continue;
    vec4 value = inherited[i];
    if (has_own) {
      vec4 light = texelFetch(own, at, 0);
      if (way == 2) light = vec4(light.rgb + value.rgb, 1.0);
      if (light.a > 0.0) value = light;
    }
    if (detail > 0.0) value.rgb *= detailFactor(frame_view.view, at, texelFetch(normals, at, 0).xy);
    imageStore(result, at, value);
  }
}
