// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The kernel of prt_gloss_vertices and of its twin under local light.
#ifndef GLOAM_PRT_GLOSS_VERTICES_GLSL
#define GLOAM_PRT_GLOSS_VERTICES_GLSL
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
#ifdef GLOAM_LOCAL_LIGHT
layout(scalar, push_constant) uniform Push { uint block_count; uint light_stride; } push;
layout(constant_id = 5) const int points = 4;
layout(constant_id = 6) const int probe_coefficients = 25;
layout(scalar, set = 0, binding = 5) readonly buffer ProbeLights { ProbeLight at[]; } probe_lights;
layout(scalar, set = 0, binding = 6) readonly buffer Places { vec3 at[]; } probe_places;
layout(scalar, set = 0, binding = 7) readonly buffer Trust { float at[]; } trust;
layout(scalar, set = 0, binding = 8) readonly buffer Positions { vec3 at[]; } positions;
#include "techniques/prt/prt_local.glsl"
layout(scalar, set = 0, binding = 9) readonly buffer Rows { LocalRow at[]; } rows;
vec3 light_reflected[36], light_all[36];

ProbeLight blended(uint first_job, int i, float weights[kMostLocalPoints]) {
  ProbeLight light = ProbeLight(vec3(0.0), vec3(0.0), vec3(0.0));
  for (int k = 0; k < points; ++k) {
    ProbeLight of_probe = probe_lights.at[(first_job + uint(k)) * uint(probe_coefficients) + uint(i)];
    light.direct += weights[k] * of_probe.direct;
    light.reflected += weights[k] * of_probe.reflected;
    light.all += weights[k] * of_probe.all;
  }
  return light;
}
#else
layout(scalar, push_constant) uniform Push { uint block_count; } push;
#endif

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

#ifdef GLOAM_LOCAL_LIGHT
#define LOAD_COLUMN(a)                                           \
  if (a < kColumns) {                                            \
    ProbeLight of_column = blended(local.first_job, a, blend);   \
    light[a] = of_column.direct;                                 \
    light_reflected[a] = of_column.reflected;                    \
    light_all[a] = of_column.all;                                \
  } else {                                                       \
    light[a] = light_reflected[a] = light_all[a] = vec3(0.0);    \
  }
#define LOAD_LIGHT(a, b) LOAD_COLUMN(a) LOAD_COLUMN(b)
#else
#define LOAD_LIGHT(a, b)                                 \
  light[a] = a < kColumns ? lights.at[first_light + uint(a)] : vec3(0.0); \
  light[b] = b < kColumns ? lights.at[first_light + uint(b)] : vec3(0.0);
#endif
#define LOAD_VISIBILITY(a, b)                \
  visibility[a] = a < kRows ? direct(a) : 0.0; \
  visibility[b] = b < kRows ? direct(b) : 0.0;
#ifdef GLOAM_LOCAL_LIGHT
// What others reflect is indirect, the first time it arrives too.
#define ADD_COLUMN(a)                       \
  if (a < kColumns) {                       \
    first += gs(i, a) * light[a];           \
    further += gs(i, a) * light_reflected[a]; \
  }
#define ADD_MATRIX(a, b) ADD_COLUMN(a) ADD_COLUMN(b)
#define ADD_INDIRECT(a, b) further += pair(i, a / 2, light_all[a], light_all[b]);
#else
#define ADD_MATRIX(a, b)                          \
  if (a < kColumns) first += gs(i, a) * light[a]; \
  if (b < kColumns) first += gs(i, b) * light[b];
#define ADD_INDIRECT(a, b) further += pair(i, a / 2, light[a], light[b]);
#endif
#define ADD_PRODUCT(a, b)                                        \
  if (a < kRows) first += visibility[a] * lights.at[row + uint(a)]; \
  if (b < kRows) first += visibility[b] * lights.at[row + uint(b)];

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
#ifdef GLOAM_LOCAL_LIGHT
  LocalRow local = rows.at[block.light / push.light_stride];
  float blend[kMostLocalPoints];
  localWeights(local,
               local.world_from_object *
                   vec4(positions.at[local.first_vertex + block.output_ + lane - local.first_output], 1.0),
               blend);
#endif
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
#ifdef GLOAM_LOCAL_LIGHT
    further *= lights.at[factors + uint(i)].x;  // rows of GI hold a lobe that is baked in already
    if (!has_indirect) first += further;
#endif
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
#endif
