// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One bit a tap along one axis: is it averaged with the pixel (RF-4)?
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(constant_id = 2) const int taps = 4;
layout(constant_id = 3) const int run = 8;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 4) writeonly buffer Masks { uint at[]; } masks;

#include "techniques/radiance_filter/radiance_filter_window.glsl"

void main() {
  int axis = int(push.limits.axis);
  ivec2 size = ivec2(push.limits.width, push.limits.height), first = runStart(axis, run), step = runStep(axis);
  if (any(greaterThanEqual(first, size))) return;
  Surface near[kMostNear];
  GLOAM_OVER_NEAR(run, taps, near[j] = surfaceAt(first + (j - reachBefore(taps)) * step, size);)
#define GLOAM_WRITE_MASK(i)                                                                \
  if (i < run) {                                                                           \
    ivec2 pixel = first + i * step;                                                        \
    if (all(lessThan(pixel, size))) {                                                      \
      Surface middle = near[i + reachBefore(taps)];                                        \
      float tolerance = toleranceAt(middle.position);                                      \
      uint same = 0u;                                                                      \
      for (int j = 0; j < reach(taps); ++j)                                                \
        same |= isSameSurface(middle, tolerance, near[i + j]) ? 1u << j : 0u;      \
      masks.at[pixel.y * size.x + pixel.x] = chosenTaps(same, taps);                       \
    }                                                                                      \
  }
  GLOAM_OVER_RUN(GLOAM_WRITE_MASK)
}
