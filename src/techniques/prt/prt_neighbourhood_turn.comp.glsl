// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The radiance in a grid, turned from its carrier's axes to those of who reads it (SH-3), band by band. One invocation a point
// and coefficient.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/prt/prt_neighbourhood_shared.h"

layout(constant_id = 0) const int field_order = 5;
layout(constant_id = 1) const bool has_indirect = true;

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer Fields { uint at[]; } fields;
layout(scalar, set = 0, binding = 1) readonly buffer Rotations { float at[]; } rotations;
layout(scalar, set = 0, binding = 2) writeonly buffer Radiance { uint at[]; } radiance;
layout(scalar, push_constant) uniform Push { NeighbourhoodTurn params; } push;

const uint kRows = uint(field_order * field_order);
const uint kWords = has_indirect ? 3u : 2u;

void main() {
  uint point = gl_GlobalInvocationID.x, i = gl_WorkGroupID.y;
  if (point >= push.params.points) return;
  uint band = 0u;
  while ((band + 1u) * (band + 1u) <= i) ++band;
  uint width = 2u * band + 1u, begin = band * band;
  uint row = push.params.first_rotation + band * (4u * band * band - 1u) / 3u + (i - begin) * width;
  if (band == 0u) row = push.params.first_rotation;
  uint from = push.params.first_in + (point * kRows + begin) * kWords;
  vec3 direct = vec3(0.0), indirect = vec3(0.0);
  for (uint b = 0u; b < width; ++b) {
    float r = rotations.at[row + b];
    vec2 x = unpackHalf2x16(fields.at[from + b * kWords]), y = unpackHalf2x16(fields.at[from + b * kWords + 1u]);
    direct += r * vec3(x, y.x);
    if (has_indirect) indirect += r * vec3(y.y, unpackHalf2x16(fields.at[from + b * kWords + 2u]));
  }
  uint to = push.params.first_out + (point * kRows + i) * kWords;
  radiance.at[to] = packHalf2x16(direct.rg);
  radiance.at[to + 1u] = packHalf2x16(vec2(direct.b, indirect.r));
  if (has_indirect) radiance.at[to + 2u] = packHalf2x16(indirect.gb);
}
