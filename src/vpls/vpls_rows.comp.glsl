// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Running sums down the rows of a map.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "vpls/vpls_shared.h"

layout(local_size_x = 1) in;
layout(scalar, set = 0, binding = 0) buffer RowSums { vec4 at[]; } row_sums;
layout(scalar, push_constant) uniform Push { MapPlace place; } push;

void main() {
  vec4 sum = vec4(0.0);
  for (int y = 0; y < push.place.size; ++y) {
    sum += row_sums.at[y];
    row_sums.at[y] = sum;
  }
}
