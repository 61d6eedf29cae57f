// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A virtual light a cell of a grid over the map (MS-2): all of the cell's flux, at the mean, weighted by flux, of where it
// falls. So lights glide as lamps and things move; none jumps from texel to texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "vpls/vpls_shared.h"

const float kPi = 3.14159265;

layout(local_size_x = 8, local_size_y = 1) in;
layout(set = 0, binding = 0) uniform sampler2D position_map;
layout(set = 0, binding = 1) uniform sampler2D normal_map;
layout(set = 0, binding = 2) uniform sampler2D flux_map;
layout(scalar, set = 0, binding = 3) writeonly buffer Rows { VplRow at[]; } rows;
layout(scalar, push_constant) uniform Push { MapPlace place; } push;

void main() {
  MapPlace place = push.place;
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, ivec2(place.grid)))) return;
  ivec2 from = cell * place.size / place.grid, to = (cell + 1) * place.size / place.grid;
  vec3 flux = vec3(0.0), position = vec3(0.0), normal = vec3(0.0);
  float area = 0.0, weight = 0.0;
  for (int y = from.y; y < to.y; ++y) {
    for (int x = from.x; x < to.x; ++x) {
      ivec2 at = place.corner + ivec2(x, y);
      vec3 f = texelFetch(flux_map, at, 0).rgb;
      float w = f.r + f.g + f.b;
      vec4 p = texelFetch(position_map, at, 0);
      flux += f;
      weight += w;
      position += w * p.xyz;
      normal += w * texelFetch(normal_map, at, 0).xyz;
      area += w > 0.0 ? p.w : 0.0;
    }
  }
  float len = length(normal);
  bool sends = weight > 0.0 && len > 1e-6 * weight;
  VplRow row;
  row.position = sends ? position / weight : vec3(0.0);
  row.bound = sends ? area / kPi : 0.0;
  row.normal = sends ? normal / len : vec3(0.0);
  row.intensity = sends ? flux / kPi : vec3(0.0);
  row.unused = row.unused_too = 0.0;
  rows.at[place.first + uint(cell.y * place.grid + cell.x)] = row;
}
