// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-3, from a level to the next coarser one.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D fine_least;
layout(set = 0, binding = 1) uniform sampler2D fine_greatest;
layout(set = 0, binding = 2) uniform sampler2D fine_positions;
layout(set = 0, binding = 3) uniform sampler2D fine_shadings;
layout(set = 0, binding = 4) uniform writeonly image2D least;
layout(set = 0, binding = 5) uniform writeonly image2D greatest;
layout(set = 0, binding = 6) uniform writeonly image2D positions;
layout(set = 0, binding = 7) uniform writeonly image2D shadings;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(least)))) return;
  ivec2 last = textureSize(fine_least, 0) - 1;
  vec4 low = vec4(2.0, 2.0, 2.0, 65504.0), high = vec4(-2.0, -2.0, -2.0, -1.0);
  vec4 position = vec4(0.0);
  vec3 shading = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 texel = 2 * at + ivec2(i & 1, i >> 1), inside = min(texel, last);
    vec4 p = texelFetch(fine_positions, inside, 0);
    float pixels = inside == texel ? p.w : 0.0;
    low = min(low, texelFetch(fine_least, inside, 0));  // beyond the edge: that of the edge, again
    high = max(high, texelFetch(fine_greatest, inside, 0));
    position += vec4(p.xyz * pixels, pixels);
    shading += texelFetch(fine_shadings, inside, 0).xyz * pixels;
  }
  float scale = 1.0 / max(position.w, 1.0);
  imageStore(least, at, low);
  imageStore(greatest, at, high);
  imageStore(positions, at, vec4(position.xyz * scale, position.w));
  imageStore(shadings, at, vec4(shading * scale, 0.0));
}
