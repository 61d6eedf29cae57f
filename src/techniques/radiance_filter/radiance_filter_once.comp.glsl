// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The filter in one pass, every pixel of the window against the one in the middle (RF-4): the twin of the two passes, and what mends them where rows
// of the window are replaced by others. Keeps how far the middle of what was taken lies off the pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(constant_id = 1) const int taps_x = 4;
layout(constant_id = 2) const int taps_y = 4;
layout(constant_id = 3) const int layers = 7;  // of a part
layout(constant_id = 4) const int parts = 1;
layout(constant_id = 5) const bool every_pixel = true;  // else those of which rows were replaced

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4) uniform sampler2DArray before;
layout(set = 0, binding = 5, rgba16f) uniform image2DArray after;
layout(scalar, set = 0, binding = 6) readonly buffer Across { uint at[]; } masks_across;
layout(scalar, set = 0, binding = 7) readonly buffer Down { uint at[]; } masks_down;
layout(scalar, set = 0, binding = 8) writeonly buffer Shifts { vec2 at[]; } shifts;

#include "techniques/radiance_filter/radiance_filter_window.glsl"

/// Steps from the middle to tap i of a line, and to what may take its place.
ivec2 waysTo(int i, int taps) {
  int way = i - tapsBefore(taps);
  return ivec2(way, replacesTaps(taps) ? (way < 0 ? way + taps : way - taps) : way);
}

/// Mean place of the taps of a line that are taken, past that of the whole window; kNoShift where some are missing.
float shiftOf(uint mask, int taps) {
  if (bitCount(mask) != taps) return kNoShift;
  int sum = 0;
  for (uint left = mask; left != 0u; left &= left - 1u) sum += findLSB(left);
  for (uint left = wholeWindow(taps); left != 0u; left &= left - 1u) sum -= findLSB(left);
  return float(sum) / float(taps);
}

/// How far the middle of what two passes took lies off, where no row is replaced: then each took its sets beside the pixel.
vec2 shiftOfRows(ivec2 pixel, ivec2 size) {
  if (masks_down.at[pixel.y * size.x + pixel.x] == 0u) return vec2(kNoShift);
  float sum = 0.0, most = 0.0;
  for (int j = 0; j < taps_y; ++j) {
    int y = pixel.y + j - tapsBefore(taps_y);
    float shift = shiftOf(masks_across.at[y * size.x + pixel.x], taps_x);
    sum += shift;
    most = max(most, shift);
  }
  return most == kNoShift ? vec2(kNoShift) : vec2(sum / float(taps_y), 0.0);
}

void main() {
  ivec2 size = ivec2(push.limits.width, push.limits.height), pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size))) return;
  int index = pixel.y * size.x + pixel.x;
  uint rows = masks_down.at[index];
  if (!every_pixel && (rows == 0u || rows == wholeWindow(taps_y))) {
    shifts.at[index] = shiftOfRows(pixel, size);
    return;
  }
  Surface middle = surfaceAt(pixel, size);
  float tolerance = toleranceAt(middle.position);
  ivec2 way_sum = ivec2(0);
  int count = 0;
  for (int part = 0; part < parts; ++part) {
    int first = part * layers;
    vec4 sum[kFieldLayers];
    for (int w = 0; w < kFieldLayers; ++w) sum[w] = vec4(0.0);
    for (int i = 0; i < taps_x * taps_y && middle.object != 0u; ++i) {
      ivec2 x = waysTo(i % taps_x, taps_x), y = waysTo(i / taps_x, taps_y), taken = ivec2(0);
      bool found = false;
      for (int k = 0; k < 4; ++k) {
        ivec2 way = ivec2(x[k & 1], y[k >> 1]);
        bool same = isSameSurface(middle, tolerance, surfaceAt(pixel + way, size));
        taken = same && !found ? way : taken;
        found = found || same;
      }
      if (!found) continue;
      if (part == 0) way_sum += taken - ivec2(x[0], y[0]), ++count;
      for (int w = 0; w < kFieldLayers; ++w)
        if (w < layers) sum[w] += texelFetch(before, ivec3(pixel + taken, first + w), 0);
    }
    for (int w = 0; w < kFieldLayers; ++w)
      if (w < layers) imageStore(after, ivec3(pixel, first + w), sum[w] / float(taps_x * taps_y));
  }
  shifts.at[index] = count == taps_x * taps_y ? vec2(way_sum) / float(count) : vec2(kNoShift);
}
