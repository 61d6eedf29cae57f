// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Virtual lights at points of the R2 sequence (Roberts 2018: steps of the plastic number), warped so that equal parts of the
// square fall on equal sums: rows first, then columns (MS-2). The sequence does not change from frame to frame.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "vpls/vpls_shared.h"

const float kPi = 3.14159265;

layout(constant_id = 0) const bool importance = true;

layout(local_size_x = 8) in;
layout(set = 0, binding = 0) uniform sampler2D position_map;
layout(set = 0, binding = 1) uniform sampler2D normal_map;
layout(set = 0, binding = 2) uniform sampler2D flux_map;
layout(scalar, set = 0, binding = 3) readonly buffer Sums { float at[]; } sums;
layout(scalar, set = 0, binding = 4) readonly buffer RowSums { vec4 at[]; } row_sums;
layout(scalar, set = 0, binding = 5) writeonly buffer Rows { VplRow at[]; } rows;
layout(scalar, push_constant) uniform Push { MapPlace place; } push;

/// First row, and in a row first column, whose running sum exceeds `sum`.
int rowAt(float sum, int size) {
  int low = 0, high = size - 1;
  while (low < high) {
    int middle = (low + high) / 2;
    if (row_sums.at[middle].w > sum) high = middle;
    else low = middle + 1;
  }
  return low;
}
int columnAt(int row, float sum, int size) {
  int low = 0, high = size - 1;
  while (low < high) {
    int middle = (low + high) / 2;
    if (sums.at[row * size + middle] > sum) high = middle;
    else low = middle + 1;
  }
  return low;
}

void main() {
  MapPlace place = push.place;
  uint count = uint(place.grid * place.grid), i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  VplRow row;
  row.position = row.normal = row.intensity = vec3(0.0);
  row.bound = row.unused = row.unused_too = 0.0;
  float total = row_sums.at[place.size - 1].w;
  if (total > 0.0) {
    // Steps as fractions of 2^32: exact for any i.
    vec2 at = vec2(uvec2(2147483648u) + i * uvec2(3242174889u, 2447445414u)) / 4294967296.0;
    int y = rowAt(min(at.y, 0.9999999) * total, place.size);
    int x = columnAt(y, min(at.x, 0.9999999) * sums.at[y * place.size + place.size - 1], place.size);
    ivec2 texel = place.corner + ivec2(x, y);
    vec3 flux = texelFetch(flux_map, texel, 0).rgb;
    float w = flux.r + flux.g + flux.b;
    vec4 p = texelFetch(position_map, texel, 0);
    if (w > 0.0) {
      float texels = total / (float(count) * (importance ? w : 1.0));  // that this light stands for
      row.position = p.xyz;
      row.normal = texelFetch(normal_map, texel, 0).xyz;
      row.intensity = flux * (texels / kPi);
      row.bound = p.w * texels / kPi;
    }
  }
  rows.at[place.first + i] = row;
}
