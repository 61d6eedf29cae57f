// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A virtual light a cell of a grid over the map (MS-2): all of the cell's flux, at the mean, weighted by flux, of where it
// falls. So lights glide as lamps and things move; none jumps from texel to texel. Where a cell holds more than one surface, the
// mean is that of the one with the most flux: between two surfaces a light would stand in the air, or behind a corner.
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

/// Places in a cell whose surfaces are tried, in sixths of its side.
const ivec2 kTried[5] = ivec2[5](ivec2(3, 3), ivec2(1, 1), ivec2(5, 1), ivec2(1, 5), ivec2(5, 5));
const float kSameNormal = 0.8, kSamePlane = 0.25;  // least cosine; rise over run

struct Point {
  vec3 position, normal;
};

Point pointAt(ivec2 at) { return Point(texelFetch(position_map, at, 0).xyz, texelFetch(normal_map, at, 0).xyz); }

/// Whether both may be of one surface, flat or bent a little. What is not there has no normal.
bool agree(Point a, Point b) {
  vec3 between = b.position - a.position;
  return dot(a.normal, b.normal) > kSameNormal && abs(dot(between, a.normal)) <= kSamePlane * length(between) + 1e-6;
}

float fluxAt(ivec2 at) { return dot(texelFetch(flux_map, at, 0).rgb, vec3(1.0)); }

void main() {
  MapPlace place = push.place;
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, ivec2(place.grid)))) return;
  ivec2 from = cell * place.size / place.grid, to = (cell + 1) * place.size / place.grid;
  Point tried[5];
  float shares[5] = float[5](0.0, 0.0, 0.0, 0.0, 0.0);
  for (int i = 0; i < 5; ++i) tried[i] = pointAt(place.corner + from + (to - from) * kTried[i] / 6);
  for (int y = from.y; y < to.y; ++y) {
    for (int x = from.x; x < to.x; ++x) {
      ivec2 at = place.corner + ivec2(x, y);
      float w = fluxAt(at);
      Point point = pointAt(at);
      for (int i = 0; i < 5; ++i) shares[i] += agree(tried[i], point) ? w : 0.0;
    }
  }
  Point chosen = tried[0];
  float share = shares[0];
  for (int i = 1; i < 5; ++i) {
    if (shares[i] > 1.001 * share) {
      chosen = tried[i];
      share = shares[i];
    }
  }
  vec3 flux = vec3(0.0), position = vec3(0.0), normal = vec3(0.0);
  float area = 0.0, weight = 0.0;
  for (int y = from.y; y < to.y; ++y) {
    for (int x = from.x; x < to.x; ++x) {
      ivec2 at = place.corner + ivec2(x, y);
      vec3 f = texelFetch(flux_map, at, 0).rgb;
      Point point = pointAt(at);
      float all = f.r + f.g + f.b, w = share <= 0.0 || agree(chosen, point) ? all : 0.0;
      flux += f;
      weight += w;
      position += w * point.position;
      normal += w * point.normal;
      area += all > 0.0 ? texelFetch(position_map, at, 0).w : 0.0;
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
