// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gpu/test_shaders/gpu_test_shared.h"
#extension GL_EXT_samplerless_texture_functions : require
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform texture2D finer;
layout(set = 0, binding = 1) uniform sampler nearest;
layout(set = 0, binding = 2, rg32f) uniform writeonly image2D coarser;

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(coarser)))) return;
  vec2 least_most = vec2(1e30, -1e30);
  for (int i = 0; i < 4; ++i) {
    const vec2 uv = (vec2(2 * pixel + ivec2(i & 1, i >> 1)) + 0.5) / vec2(textureSize(finer, 0));
    const vec2 value = textureLod(sampler2D(finer, nearest), uv, 0.0).xy;
    least_most = vec2(min(least_most.x, value.x), max(least_most.y, value.y));
  }
  imageStore(coarser, pixel, vec4(least_most, 0.0, 0.0));
}
