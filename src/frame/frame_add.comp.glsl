// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The sum of two terms of light.
#version 460

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D a;
layout(set = 0, binding = 1) uniform sampler2D b;
layout(set = 0, binding = 2) uniform writeonly image2D both;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(both)))) return;
  imageStore(both, pixel, texelFetch(a, pixel, 0) + texelFetch(b, pixel, 0));
}
