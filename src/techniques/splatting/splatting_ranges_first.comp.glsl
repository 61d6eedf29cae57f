// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-3, level 1: ranges and means of 2 x 2 pixels, background left out.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/gbuffer.glsl"
#include "techniques/splatting/splatting_ranges.glsl"

layout(constant_id = 0) const bool by_shading_normal = false;

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform usampler2D normals;
layout(set = 0, binding = 2) uniform writeonly uimage2D ranges;
layout(set = 0, binding = 3) uniform writeonly uimage2D means;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(ranges)))) return;
  ivec2 size = textureSize(depth, 0);
  Ranges range = kNothing;
  float count = 0.0, sum = 0.0;
  vec3 shading = vec3(0.0);
  vec2 middle = vec2(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 within = ivec2(i & 1, i >> 1), pixel = 2 * at + within, inside = min(pixel, size - 1);
    float d = texelFetch(depth, inside, 0).x;
    uvec2 packed_normals = texelFetch(normals, inside, 0).xy;
    bool covered = d > 0.0 && inside == pixel;
    vec3 shaded = shadingNormal(packed_normals);
    vec3 ranged = by_shading_normal ? shaded : geometricNormal(packed_normals);
    range.low = covered ? min(range.low, ranged) : range.low;
    range.high = covered ? max(range.high, ranged) : range.high;
    range.near = covered ? max(range.near, d) : range.near;
    range.far = covered ? min(range.far, d) : range.far;
    float one = covered ? 1.0 : 0.0;
    count += one;
    sum += one * d;
    shading += one * shaded;
    middle += one * (0.5 * vec2(within) + 0.25);
  }
  float scale = 1.0 / max(count, 1.0);
  imageStore(ranges, at, packRanges(range));
  imageStore(means, at, packMeans(Means(sum * scale, shading * scale, 0.25 * count, middle * scale)));
}
