// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The kernel of prt_gloss_vertices and of its twin under local light.
#ifndef GLOAM_PRT_GLOSS_VERTICES_GLSL
#define GLOAM_PRT_GLOSS_VERTICES_GLSL
#include "techniques/prt/prt_pairs.glsl"
#include "techniques/prt/prt_shared.h"

layout(constant_id = 0) const int light_order = 5;
layout(constant_id = 1) const int field_order = 5;
layout(constant_id = 2) const bool has_indirect = true;
layout(constant_id = 3) const bool half_float = false;
layout(constant_id = 4) const bool cheap = false;

layout(local_size_x = kBlockVertices) in;
layout(scalar, set = 0, binding = 0) readonly buffer Blocks { VertexBlock at[]; } blocks;
layout(scalar, set = 0, binding = 1) readonly buffer TransferDirect { uint at[]; } transfer_direct;
layout(scalar, set = 0, binding = 2) readonly buffer TransferIndirect { uint at[]; } transfer_indirect;
layout(scalar, set = 0, binding = 3) readonly buffer Lights { vec3 at[]; } lights;
layout(scalar, set = 0, binding = 4) writeonly buffer Fields { uint at[]; } fields;
#ifdef GLOAM_LOCAL_LIGHT
#include "techniques/prt/prt_local_gloss.glsl"
#else
layout(scalar, push_constant) uniform Push { uint block_count; } push;
#endif

const int kColumns = light_order * light_order;
const int kRows = field_order * field_order;
const int kTriangle = kColumns * (kColumns + 1) / 2;
const int kDirectValues = cheap ? kRows : kTriangle + (kRows - kColumns) * kColumns;
const int kPairs = (kColumns + 1) / 2;  // of columns, in a row of `indirect`

vec3 light[36];
uint first_direct, first_indirect, first_light;
#include "techniques/prt/prt_gloss_matrix.glsl"
#ifdef GLOAM_LOCAL_LIGHT
#include "techniques/prt/prt_local_gloss_columns.glsl"
#else
#define LOAD_LIGHT(a, b)                                 \
  light[a] = a < kColumns ? lights.at[first_light + uint(a)] : vec3(0.0); \
  light[b] = b < kColumns ? lights.at[first_light + uint(b)] : vec3(0.0);
#define ADD_MATRIX(a, b)                          \
  if (a < kColumns) first += gs(i, a) * light[a]; \
  if (b < kColumns) first += gs(i, b) * light[b];
#define ADD_INDIRECT(a, b) further += pair(i, a / 2, light[a], light[b]);
#endif
#define LOAD_VISIBILITY(a, b)                \
  visibility[a] = a < kRows ? direct(a) : 0.0; \
  visibility[b] = b < kRows ? direct(b) : 0.0;
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
