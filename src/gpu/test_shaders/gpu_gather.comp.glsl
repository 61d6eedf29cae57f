// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gpu/test_shaders/gpu_test_shared.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D source;
layout(scalar, set = 0, binding = 1) writeonly buffer Sums { float sums[]; };

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  const ivec2 size = textureSize(source, 0);
  if (any(greaterThanEqual(pixel, size))) return;
  sums[pixel.y * size.x + pixel.x] = texelFetch(source, pixel, 0).z;
}
