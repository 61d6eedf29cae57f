// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One level of MS-6: its own light, or that from the next coarser level; and which neighbours go with a texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_shared.h"
#include "techniques/splatting/splatting_upsample.glsl"

layout(constant_id = 0) const bool coarsest = false;
layout(constant_id = 1) const bool along_surfaces = true;

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D own;  // of subsplats; smaller where the level has none
layout(set = 0, binding = 1) uniform sampler2D coarse;
layout(set = 0, binding = 2) uniform sampler2D least;
layout(set = 0, binding = 3) uniform sampler2D greatest;
layout(set = 0, binding = 4) uniform writeonly image2D result;
layout(scalar, push_constant) uniform Push { Thresholds thresholds; } push;

/// Neighbours with which this texel varies by no more than two texels of a smooth surface may.
uint neighbours(ivec2 at) {
  ivec2 last = textureSize(least, 0) - 1;
  vec4 low = texelFetch(least, at, 0), high = texelFetch(greatest, at, 0);
  uint bits = 0u;
  for (int i = 0; i < 9; ++i) {
    ivec2 step = ivec2(i % 3, i / 3) - 1;
    if (i == 4) continue;
    ivec2 next = clamp(at + step, ivec2(0), last);
    vec4 both_low = min(low, texelFetch(least, next, 0));
    vec4 span = max(high, texelFetch(greatest, next, 0)) - both_low;
    bool smooth_on = max(span.x, max(span.y, span.z)) <= 2.0 * push.thresholds.normal && span.w <= 2.0 * push.thresholds.depth * both_low.w;
    bits |= smooth_on ? neighbourBit(step) : 0u;
  }
  return bits;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, imageSize(result)))) return;
  vec4 value = all(lessThan(at, textureSize(own, 0))) ? texelFetch(own, at, 0) : vec4(0.0);
  if (way == 2) {
    if (value.a < 0.0) value = vec4(0.0);
    if (!coarsest) value = vec4(value.rgb + fromCoarser(coarse, at).rgb, 1.0);
  }
  if (!coarsest && value.a == 0.0) value = fromCoarser(coarse, at);
  uint bits = along_surfaces ? neighbours(at) : 255u;
  imageStore(result, at, value.a != 0.0 ? vec4(value.rgb, sign(value.a) * (1.0 + float(bits))) : vec4(0.0));
}
