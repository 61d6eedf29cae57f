// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What is left of the light at baked vertices that stand in others' neighbourhoods, M_DS . L_p (PRT-6): L_p as the grid has it
// there, in the vertex's own axes. Shadows of several objects multiply, what they throw adds. One work group a block of vertices.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define GLOAM_RADIANCE_BINDING 0
#include "techniques/prt/prt_neighbourhood.glsl"
#include "techniques/prt/prt_ringing.glsl"
#include "techniques/prt/prt_shared.h"

layout(constant_id = 0) const int coefficients = 25;  // of transfer
layout(constant_id = 1) const bool has_indirect = true;
layout(constant_id = 2) const bool half_float = false;
layout(constant_id = 3) const int field_order = 5;
layout(constant_id = 4) const bool has_thrown = true;
layout(constant_id = 5) const bool damped = false;

layout(local_size_x = kBlockVertices) in;
layout(scalar, set = 0, binding = 1) readonly buffer Blocks { VertexBlock at[]; } blocks;
layout(scalar, set = 0, binding = 2) readonly buffer TransferDirect { uint at[]; } transfer_direct;
layout(scalar, set = 0, binding = 3) readonly buffer TransferIndirect { uint at[]; } transfer_indirect;
layout(scalar, set = 0, binding = 4) readonly buffer Lights { vec3 at[]; } lights;
layout(scalar, set = 0, binding = 5) readonly buffer Readers { NeighbourhoodReader at[]; } readers;
layout(scalar, set = 0, binding = 6) readonly buffer Grids { NeighbourhoodGrid at[]; } grids;
layout(scalar, set = 0, binding = 7) readonly buffer Positions { vec3 at[]; } positions;
layout(scalar, set = 0, binding = 8) buffer VertexLights { VertexLight at[]; } vertex_light;
layout(scalar, push_constant) uniform Push { NeighbourhoodVertices params; } push;

const uint kWords = has_thrown ? 3u : 2u;
const uint kRows = uint(field_order * field_order);
const uint kCoefficients = uint(coefficients);
#include "techniques/prt/prt_values.glsl"

void main() {
  uint number = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (number >= push.params.block_count) return;
  VertexBlock block = blocks.at[number];
  uint lane = gl_LocalInvocationID.x, output_ = block.output_ + lane;
  if (lane >= block.count) return;
  for (uint r = 0u; r < push.params.reader_count; ++r) {
    NeighbourhoodReader reader = readers.at[r];
    if (output_ < reader.first_output || output_ >= reader.first_output + reader.vertex_count) continue;
    vec3 position = positions.at[reader.first_position + output_ - reader.first_output];
    VertexLight result = vertex_light.at[output_];
    vec3 arrived = vec3(0.0);
    for (uint g = reader.first_grid; g < reader.first_grid + reader.grid_count; ++g) {
      GridPlace place = placeInGrid(grids.at[g], position, kRows * kWords);
      if (place.share == 0.0) continue;
      vec3 open = vec3(0.0), shadowed = open, open_bounced = open, shadowed_bounced = open, thrown = open;
      vec3 soft = open, soft_bounced = open;
      for (uint i = 0u; i < min(kRows, uint(coefficients)); ++i) {
        vec3 first = vec3(0.0), further = vec3(0.0);
        for (uint corner = 0u; corner < 8u; ++corner) {
          uint at = cornerWord(place, corner) + i * kWords;
          float weight = cornerWeight(place, corner);
          vec2 a = unpackHalf2x16(radiance.at[at]), b = unpackHalf2x16(radiance.at[at + 1u]);
          first += weight * vec3(a, b.x);
          if (has_thrown) further += weight * vec3(b.y, unpackHalf2x16(radiance.at[at + 2u]));
        }
        vec3 light = lights.at[reader.first_light + i];
        float m = direct(block.transfer, i, lane);
        open += m * light;
        shadowed += m * first;
        float soft_share = damped ? softened(uint(sqrt(float(i) + 0.5)), field_order) : 0.0;
        soft += soft_share * m * first;
        thrown += m * further;
        if (has_indirect) {
          vec3 bounced = indirect(block.transfer, i, lane);
          open_bounced += bounced * light;
          shadowed_bounced += bounced * first;
          soft_bounced += soft_share * bounced * first;
          thrown += bounced * further;
        }
      }
      if (damped) {
        shadowed = withoutRinging(shadowed, soft);
        shadowed_bounced = withoutRinging(shadowed_bounced, soft_bounced);
      }
      result.direct *= leftInShadow(open, shadowed, place.share);
      if (has_indirect) result.indirect *= leftInShadow(open_bounced, shadowed_bounced, place.share);
      arrived += place.share * max(thrown, vec3(0.0));
    }
    result.indirect += push.params.exposure * arrived;
    vertex_light.at[output_] = result;
    return;
  }
}
