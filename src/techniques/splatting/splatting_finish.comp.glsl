// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The last level of MS-6, pixels; and MS-7: c (a max(0, V.N) + 1 - a).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "techniques/splatting/splatting_upsample.glsl"

layout(constant_id = 0) const float detail = 0.0;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D own;
layout(set = 0, binding = 2) uniform sampler2D coarse;
layout(set = 0, binding = 3) uniform usampler2D normals;
layout(set = 0, binding = 4) uniform writeonly image2D result;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(result)))) return;
  vec4 value = all(lessThan(at, textureSize(own, 0))) ? texelFetch(own, at, 0) : vec4(0.0);
  if (way == 2) value = vec4(value.rgb + fromCoarser(coarse, at).rgb, 1.0);
  if (value.a <= 0.0) value = fromCoarser(coarse, at);
  if (detail > 0.0) {
    vec3 to_eye = -normalize(pixelRay(frame_view.view, vec2(at) + 0.5).direction);
    float cosine = max(dot(shadingNormal(texelFetch(normals, at, 0).xy), to_eye), 0.0);
    value.rgb *= detail * cosine + 1.0 - detail;
  }
  imageStore(result, at, value);
}
