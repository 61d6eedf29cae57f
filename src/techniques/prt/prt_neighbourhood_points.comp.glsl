// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The radiance at the points of a neighbourhood: its matrices times the light, once a frame. What arrives of the distant light
// is P V, P the light's product matrix (exact, see math/sh_high_order.h); what the object throws is (GI - GS) L. One
// invocation a point and coefficient; points lie side by side in memory.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/prt/prt_neighbourhood_shared.h"

layout(constant_id = 0) const int light_order = 5;
layout(constant_id = 1) const int field_order = 5;
layout(constant_id = 2) const bool has_indirect = true;

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer Visibility { float at[]; } visibility;
layout(scalar, set = 0, binding = 1) readonly buffer Thrown { uint at[]; } thrown;
layout(scalar, set = 0, binding = 2) readonly buffer Lights { vec3 at[]; } lights;  // L, then P row by row
layout(scalar, set = 0, binding = 3) writeonly buffer Fields { uint at[]; } fields;
layout(scalar, push_constant) uniform Push { NeighbourhoodPoints params; } push;

const uint kColumns = uint(light_order * light_order);
const uint kRows = uint(field_order * field_order);
const uint kBands = uint(light_order + field_order - 1);
const uint kPairs = (kColumns + 1u) / 2u;

void main() {
  uint point = gl_GlobalInvocationID.x, points = push.params.points, row = gl_WorkGroupID.y;
  if (point >= points) return;
  uint i = push.params.first_row + row;
  vec3 direct = vec3(0.0), indirect = vec3(0.0);
  for (uint k = 0u; k < kBands * kBands; ++k)
    direct += visibility.at[k * points + point] * lights.at[kColumns + i * kBands * kBands + k];
  uint to = push.params.first_word + (point * kRows + i) * (has_indirect ? 3u : 2u);
  fields.at[to] = packHalf2x16(direct.rg);
  if (!has_indirect) {
    fields.at[to + 1u] = packHalf2x16(vec2(direct.b, 0.0));
    return;
  }
  for (uint p = 0u; p < kPairs; ++p) {
    uint at = (row * kPairs + p) * 3u * points + point;
    vec2 a = unpackHalf2x16(thrown.at[at]), b = unpackHalf2x16(thrown.at[at + points]);
    vec2 c = unpackHalf2x16(thrown.at[at + 2u * points]);
    indirect += vec3(a, b.x) * lights.at[2u * p];
    if (2u * p + 1u < kColumns) indirect += vec3(b.y, c) * lights.at[2u * p + 1u];
  }
  fields.at[to + 1u] = packHalf2x16(vec2(direct.b, indirect.r));
  fields.at[to + 2u] = packHalf2x16(indirect.gb);
}
