// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-3, from a level to the next coarser one.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_ranges.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform usampler2D fine_ranges;
layout(set = 0, binding = 1) uniform usampler2D fine_means;
layout(set = 0, binding = 2) uniform writeonly uimage2D ranges;
layout(set = 0, binding = 3) uniform writeonly uimage2D means;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(ranges)))) return;
  ivec2 last = textureSize(fine_ranges, 0) - 1;
  Ranges range = kNothing;
  Means sum = Means(0.0, vec3(0.0), 0.0, vec2(0.0));
  for (int i = 0; i < 4; ++i) {
    ivec2 within = ivec2(i & 1, i >> 1), texel = 2 * at + within, inside = min(texel, last);
    range = joined(range, unpackRanges(texelFetch(fine_ranges, inside, 0)));  // beyond the edge: that of the edge, again
    Means fine = unpackMeans(texelFetch(fine_means, inside, 0));
    float weight = inside == texel ? fine.covered : 0.0;
    sum.depth += weight * fine.depth;
    sum.shading += weight * fine.shading;
    sum.covered += weight;
    sum.middle += weight * 0.5 * (vec2(within) + fine.middle);
  }
  float scale = sum.covered > 0.0 ? 1.0 / sum.covered : 0.0;
  imageStore(ranges, at, packRanges(range));
  imageStore(means, at, packMeans(Means(sum.depth * scale, sum.shading * scale, 0.25 * sum.covered, sum.middle * scale)));
}
