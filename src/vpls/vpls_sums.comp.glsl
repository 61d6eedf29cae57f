// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Running sums along each row of a map, of flux or, spread evenly, of what is lit at all; and the row's whole flux.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "vpls/vpls_shared.h"

layout(constant_id = 0) const bool importance = true;

layout(local_size_x = 8) in;
layout(set = 0, binding = 0) uniform sampler2D flux_map;
layout(scalar, set = 0, binding = 1) writeonly buffer Sums { float at[]; } sums;
layout(scalar, set = 0, binding = 2) writeonly buffer RowSums { vec4 at[]; } row_sums;  // flux; w: of the running sum
layout(scalar, push_constant) uniform Push { MapPlace place; } push;

void main() {
  MapPlace place = push.place;
  int y = int(gl_GlobalInvocationID.x);
  if (y >= place.size) return;
  vec3 flux = vec3(0.0);
  float sum = 0.0;
  for (int x = 0; x < place.size; ++x) {
    vec3 f = texelFetch(flux_map, place.corner + ivec2(x, y), 0).rgb;
    float w = f.r + f.g + f.b;
    flux += f;
    sum += importance ? w : (w > 0.0 ? 1.0 : 0.0);
    sums.at[y * place.size + x] = sum;
  }
  row_sums.at[y] = vec4(flux, sum);
}
