// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Box filter over supersample x supersample pixels, in linear radiance.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D direct_samples;
layout(set = 0, binding = 1) uniform sampler2D indirect_samples;
layout(set = 0, binding = 2) uniform writeonly image2D color;
layout(set = 0, binding = 3) uniform writeonly image2D direct;
layout(set = 0, binding = 4) uniform writeonly image2D indirect;
layout(scalar, push_constant) uniform Push { uint supersample; } push;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(color)))) return;
  int side = int(push.supersample);
  vec4 first = vec4(0.0), further = vec4(0.0);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      first += texelFetch(direct_samples, pixel * side + ivec2(x, y), 0);
      further += texelFetch(indirect_samples, pixel * side + ivec2(x, y), 0);
    }
  }
  first /= float(side * side);
  further /= float(side * side);
  imageStore(direct, pixel, vec4(first.rgb, 1.0));
  imageStore(indirect, pixel, vec4(further.rgb, 0.0));
  imageStore(color, pixel, vec4(first.rgb + further.rgb, first.a));
}
