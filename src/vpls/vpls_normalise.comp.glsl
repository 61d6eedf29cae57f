// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Lights drawn from a map get its flux, colour by colour.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "vpls/vpls_shared.h"

const float kPi = 3.14159265;
const uint kLanes = 64u;

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer RowSums { vec4 at[]; } row_sums;
layout(scalar, set = 0, binding = 1) buffer Rows { VplRow at[]; } rows;
layout(scalar, push_constant) uniform Push { MapPlace place; } push;

shared vec3 sums[64];

void main() {
  MapPlace place = push.place;
  uint lane = gl_LocalInvocationID.x, count = uint(place.grid * place.grid);
  vec3 sum = vec3(0.0);
  for (uint i = lane; i < count; i += kLanes) sum += rows.at[place.first + i].intensity;
  sums[lane] = sum;
  barrier();
  vec3 drawn = vec3(0.0);
  for (uint i = 0u; i < kLanes; ++i) drawn += sums[i];
  vec3 wanted = row_sums.at[place.size - 1].rgb / kPi;
  vec3 factor = mix(vec3(0.0), wanted / max(drawn, vec3(1e-30)), greaterThan(drawn, vec3(0.0)));
  for (uint i = lane; i < count; i += kLanes) rows.at[place.first + i].intensity *= factor;
}
