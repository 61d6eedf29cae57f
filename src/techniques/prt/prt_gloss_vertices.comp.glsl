// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The radiance that arrives at a vertex, in SH: its transfer matrices times its object's light (PRT-2). GS is symmetric as
// far as it is square and stored so; where only V is kept, it is multiplied by the light's product matrix instead (the
// triple product). Loops over columns are written out: arrays with constant places stay in registers. One work group a
// block of vertices.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/prt/prt_shared.h"

layout(constant_id = 0) const int light_order = 5;
layout(constant_id = 1) const int field_order = 5;
layout(constant_id = 2) const bool has_indirect = true;
layout(constant_id = 3) const bool half_float = false;
layout(constant_id = 4) const bool cheap = false;

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer Blocks { VertexBlock at[]; } blocks;
layout(scalar, set = 0, binding = 1) readonly buffer TransferDirect { uint at[]; } transfer_direct;
layout(scalar, set = 0, binding = 2) readonly buffer TransferIndirect { uint at[]; } transfer_indirect;
layout(scalar, set = 0, binding = 3) readonly buffer Lights { vec3 at[]; } lights;
layout(scalar, set = 0, binding = 4) writeonly buffer Fields { uint at[]; } fields;
layout(scalar, push_constant) uniform Push { uint block_count; } push;

const int kColumns = light_order * light_order;
const int kRows = field_order * field_order;
const int kTriangle = kColumns * (kColumns + 1) / 2;
const int kDirectValues = cheap ? kRows : kTriangle + (kRows - kColumns) * kColumns;
const int kPairs = (kColumns + 1) / 2;  // of columns, in a row of `indirect`

uint first_direct, first_indirect, first_light;

float direct(int i) {
  if (!half_float) return uintBitsToFloat(transfer_direct.at[first_direct + uint(i) * kBlockVertices]);
  return unpackHalf2x16(transfer_direct.at[first_direct + uint(i >> 1) * kBlockVertices])[i & 1];
}
float gs(int i, int j) {
  if (i >= kColumns) return direct(kTriangle + (i - kColumns) * kColumns + j);
  return direct(j <= i ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i);
}
/// Row i, columns 2 pair and 2 pair + 1, of GI - GS times two coefficients of the light.
vec3 pair(int i, int pair, vec3 even, vec3 odd) {
  uint at = first_indirect;
  if (half_float) {
    at += uint(3 * (i * kPairs + pair)) * kBlockVertices;
    vec2 a = unpackHalf2x16(transfer_indirect.at[at]), b = unpackHalf2x16(transfer_indirect.at[at + kBlockVertices]);
    vec2 c = unpackHalf2x16(transfer_indirect.at[at + 2u * kBlockVertices]);
    return vec3(a, b.x) * even + vec3(b.y, c) * odd;
  }
  at += uint(6 * (i * kPairs + pair)) * kBlockVertices;
  float m[6];
  for (int k = 0; k < 6; ++k) m[k] = uintBitsToFloat(transfer_indirect.at[at + uint(k) * kBlockVertices]);
  return vec3(m[0], m[1], m[2]) * even + vec3(m[3], m[4], m[5]) * odd;
}

// Pairs of columns 2p, 2p + 1 of 9, 16, 25 and 36, of which the first are in use. WORK(even column, odd column).
#define PAIRS_9(WORK) WORK(0, 1) WORK(2, 3) WORK(4, 5) WORK(6, 7) WORK(8, 9)
#define PAIRS_16(WORK) WORK(10, 11) WORK(12, 13) WORK(14, 15)
#define PAIRS_25(WORK) WORK(16, 17) WORK(18, 19) WORK(20, 21) WORK(22, 23) WORK(24, 25)
#define PAIRS_36(WORK) WORK(26, 27) WORK(28, 29) WORK(30, 31) WORK(32, 33) WORK(34, 35)
#define PAIRS(count, WORK)            \
  PAIRS_9(WORK)                       \
  if (count > 9) { PAIRS_16(WORK) }   \
  if (count > 16) { PAIRS_25(WORK) }  \
  if (count > 25) { PAIRS_36(WORK) }

#define LOAD_LIGHT(a, b)                                 \
  light[a] = a < kColumns ? lights.at[first_light + uint(a)] : vec3(0.0); \
  light[b] = b < kColumns ? lights.at[first_light + uint(b)] : vec3(0.0);
#define LOAD_VISIBILITY(a, b)                \
  visibility[a] = a < kRows ? direct(a) : 0.0; \
  visibility[b] = b < kRows ? direct(b) : 0.0;
#define ADD_MATRIX(a, b)                          \
  if (a < kColumns) first += gs(i, a) * light[a]; \
  if (b < kColumns) first += gs(i, b) * light[b];
#define ADD_PRODUCT(a, b)                                        \
  if (a < kRows) first += visibility[a] * lights.at[row + uint(a)]; \
  if (b < kRows) first += visibility[b] * lights.at[row + uint(b)];
#define ADD_INDIRECT(a, b) further += pair(i, a / 2, light[a], light[b]);

void main() {
  uint number = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (number >= push.block_count) return;
  VertexBlock block = blocks.at[number];
  uint lane = gl_LocalInvocationID.x;
  if (lane >= block.count) return;
  const int direct_words = half_float ? (kDirectValues + 1) / 2 : kDirectValues;
  const int indirect_words = kRows * kPairs * (half_float ? 3 : 6);
  first_direct = block.transfer * uint(direct_words) * kBlockVertices + lane;
  first_indirect = block.transfer * uint(indirect_words) * kBlockVertices + lane;
  first_light = block.light;
  vec3 light[36];
  PAIRS(kColumns, LOAD_LIGHT)
  float visibility[36];
  if (cheap) { PAIRS(kRows, LOAD_VISIBILITY) }
  uint factors = first_light + uint(kColumns);
  uint to = (block.output_ + lane) * uint(kRows) * (has_indirect ? 3u : 2u);
  for (int i = 0; i < kRows; ++i) {
    vec3 first = vec3(0.0), further = vec3(0.0);
    if (cheap) {
      uint row = factors + uint(kRows) + uint(i * kRows);
      PAIRS(kRows, ADD_PRODUCT)
    } else {
      PAIRS(kColumns, ADD_MATRIX)
    }
    first *= lights.at[factors + uint(i)].x;
    fields.at[to] = packHalf2x16(first.rg);
    if (has_indirect) {
      PAIRS(kColumns, ADD_INDIRECT)
      fields.at[to + 1u] = packHalf2x16(vec2(first.b, further.r));
      fields.at[to + 2u] = packHalf2x16(further.gb);
      to += 3u;
    } else {
      fields.at[to + 1u] = packHalf2x16(vec2(first.b, 0.0));
      to += 2u;
    }
  }
}
