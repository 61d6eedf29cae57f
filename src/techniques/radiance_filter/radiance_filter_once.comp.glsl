// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The filter in one pass, every pixel of the window against the one in the middle (RF-4): the twin of the two passes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "techniques/radiance_filter/radiance_filter_shared.h"

layout(constant_id = 1) const int taps_x = 4;
layout(constant_id = 2) const int taps_y = 4;
layout(constant_id = 3) const int layers = 7;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D ids;
layout(set = 0, binding = 3) uniform usampler2D normals;
layout(set = 0, binding = 4) uniform sampler2DArray before;
layout(set = 0, binding = 5) uniform writeonly image2DArray after;
layout(scalar, push_constant) uniform Push { FilterLimits limits; } push;

#include "techniques/radiance_filter/radiance_filter_window.glsl"

/// Steps from the middle to tap i of a line, and to what may take its place.
ivec2 waysTo(int i, int taps) {
  int way = i - tapsBefore(taps);
  return ivec2(way, replacesTaps(taps) ? (way < 0 ? way + taps : way - taps) : way);
}

void main() {
  ivec2 size = ivec2(push.limits.width, push.limits.height), pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size))) return;
  int first = int(gl_GlobalInvocationID.z) * layers;
  Surface middle = surfaceAt(pixel, size);
  float tolerance = toleranceAt(middle.position);
  vec4 sum[kFieldLayers];
  for (int w = 0; w < kFieldLayers; ++w) sum[w] = vec4(0.0);
  for (int i = 0; i < taps_x * taps_y && middle.object != 0u; ++i) {
    ivec2 x = waysTo(i % taps_x, taps_x), y = waysTo(i / taps_x, taps_y), taken = ivec2(0);
    bool found = false;
    for (int k = 0; k < 4; ++k) {
      ivec2 tap = pixel + ivec2(x[k & 1], y[k >> 1]);
      bool same = isSameSurface(middle, tolerance, surfaceAt(tap, size));
      taken = same && !found ? tap : taken;
      found = found || same;
    }
    if (!found) continue;
    for (int w = 0; w < kFieldLayers; ++w)
      if (w < layers) sum[w] += texelFetch(before, ivec3(taken, first + w), 0);
  }
  for (int w = 0; w < kFieldLayers; ++w)
    if (w < layers) imageStore(after, ivec3(pixel, first + w), sum[w] / float(taps_x * taps_y));
}
