// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pixels that have gloss.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform sampler2D specular;
layout(scalar, set = 0, binding = 2) buffer CountBlock { uint value; } count;
layout(scalar, set = 0, binding = 3) writeonly buffer Shiny { uint at[]; } shiny;

void main() {
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = 2 * ivec2(gl_GlobalInvocationID.xy) + ivec2(i & 1, i >> 1);
    if (any(greaterThanEqual(pixel, textureSize(depth, 0))) || texelFetch(depth, pixel, 0).x <= 0.0) continue;
    vec3 ks = texelFetch(specular, pixel, 0).rgb;
    if (ks.r + ks.g + ks.b > 0.0) shiny.at[atomicAdd(count.value, 1u)] = uint(pixel.x) | (uint(pixel.y) << 16);
  }
}
