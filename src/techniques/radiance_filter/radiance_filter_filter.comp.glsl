// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One axis of the filter: mean over the window of what counts, the rest as 0. The last half of a part is the weight, which goes
// through as the others do: values over weight are the mean over what both passes took.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/radiance_filter/radiance_filter_line.glsl"

layout(constant_id = 1) const int taps = 4;
layout(constant_id = 2) const int run = 8;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) readonly buffer Masks { uint at[]; } masks;
layout(set = 0, binding = 1) uniform sampler2DArray before;
layout(set = 0, binding = 2) uniform writeonly image2DArray after;
layout(scalar, push_constant) uniform Push { int axis; } push;

vec4 tapOr(uint mask, int tap, vec4 value, vec4 other) { return (mask & (1u << tap)) != 0u ? value : other; }

void main() {
  ivec2 size = imageSize(after).xy, first = runStart(push.axis, run), step = runStep(push.axis);
  if (any(greaterThanEqual(first, size))) return;
  int layer = int(gl_GlobalInvocationID.z);
  vec4 near[kMostNear];
  GLOAM_OVER_NEAR(run, taps, {
    ivec2 place = clamp(first + (j - reachBefore(taps)) * step, ivec2(0), size - 1);
    near[j] = texelFetch(before, ivec3(place, layer), 0);
  })
#define GLOAM_FILTER(i)                                                                                                  \
  if (i < run) {                                                                                                         \
    ivec2 pixel = first + i * step;                                                                                      \
    if (all(lessThan(pixel, size))) {                                                                                    \
      uint mask = masks.at[pixel.y * size.x + pixel.x];                                                                  \
      vec4 sum = vec4(0.0);                                                                                              \
      for (int k = 0; k < taps; ++k) {                                                                                   \
        int j = k + reachBefore(taps) - tapsBefore(taps), other = replacementOf(j, taps);                                \
        vec4 instead = replacesTaps(taps) ? tapOr(mask, other, near[i + other], vec4(0.0)) : vec4(0.0);                  \
        sum += tapOr(mask, j, near[i + j], instead);                                                                     \
      }                                                                                                                  \
      imageStore(after, ivec3(pixel, layer), sum / float(taps));                                                         \
    }                                                                                                                    \
  }
  GLOAM_OVER_RUN(GLOAM_FILTER)
}
