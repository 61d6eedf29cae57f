// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A vertex's irradiance under local light: its transfer vectors times the light of its object's probes, blended by weight
// at the vertex (Sloan, Kautz, Snyder 2002, section 4: incident lighting L_p). Light that other surfaces reflect is
// indirect, the first time it arrives too. One work group a block of vertices.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/probe_shared.h"
#include "techniques/prt/prt_ringing.glsl"
#include "techniques/prt/prt_shared.h"

layout(constant_id = 0) const int order = 5;
layout(constant_id = 1) const bool has_indirect = true;
layout(constant_id = 2) const bool half_float = false;
layout(constant_id = 3) const bool damped = false;  // a window of the light is mixed in where ringing shows
layout(constant_id = 4) const int points = 4;

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer Blocks { VertexBlock at[]; } blocks;
layout(scalar, set = 0, binding = 1) readonly buffer TransferDirect { uint at[]; } transfer_direct;
layout(scalar, set = 0, binding = 2) readonly buffer TransferIndirect { uint at[]; } transfer_indirect;
layout(scalar, set = 0, binding = 3) readonly buffer Lights { ProbeLight at[]; } lights;
layout(scalar, set = 0, binding = 4) writeonly buffer VertexLights { VertexLight at[]; } vertex_light;
layout(scalar, set = 0, binding = 6) readonly buffer Places { vec3 at[]; } probe_places;
layout(scalar, set = 0, binding = 7) readonly buffer Trust { float at[]; } trust;
layout(scalar, set = 0, binding = 8) readonly buffer Positions { vec3 at[]; } positions;
layout(scalar, push_constant) uniform Push { uint block_count; } push;
#include "techniques/prt/prt_local.glsl"
layout(scalar, set = 0, binding = 5) readonly buffer Rows { LocalRow at[]; } rows;

const uint kCoefficients = uint(order * order);
const float kPi = 3.14159265;

/// Value i of a lane's vertex. Halves stand two a word.
float direct(uint block, uint i, uint lane) {
  if (!half_float) return uintBitsToFloat(transfer_direct.at[(block * kCoefficients + i) * kBlockVertices + lane]);
  uint words = (kCoefficients + 1u) / 2u;
  return unpackHalf2x16(transfer_direct.at[(block * words + (i >> 1)) * kBlockVertices + lane])[i & 1u];
}
float indirect(uint block, uint i, uint lane) {
  if (!half_float) return uintBitsToFloat(transfer_indirect.at[(block * 3u * kCoefficients + i) * kBlockVertices + lane]);
  uint words = (3u * kCoefficients + 1u) / 2u;
  return unpackHalf2x16(transfer_indirect.at[(block * words + (i >> 1)) * kBlockVertices + lane])[i & 1u];
}

void main() {
  uint number = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (number >= push.block_count) return;
  VertexBlock block = blocks.at[number];
  uint lane = gl_LocalInvocationID.x;
  if (lane >= block.count) return;
  uint lit = block.light / kCoefficients;
  LocalRow row = rows.at[lit];
  vec3 place = row.middle;
  if (row.first_vertex != kUnbaked)
    place = row.world_from_object * vec4(positions.at[row.first_vertex + block.output_ + lane - row.first_output], 1.0);
  float weights[kMostLocalPoints];
  localWeights(row, place, weights);

  VertexLight sum = VertexLight(vec3(0.0), vec3(0.0)), soft = sum;
  uint i = 0u;
  for (int band = 0; band < order; ++band) {
    float window = 0.5 + 0.5 * cos(kPi * float(band) / float(order));
    for (uint end = uint((band + 1) * (band + 1)); i < end; ++i) {
      ProbeLight light = ProbeLight(vec3(0.0), vec3(0.0), vec3(0.0));
      for (int k = 0; k < points; ++k) {
        ProbeLight of_probe = lights.at[(row.first_job + uint(k)) * kCoefficients + i];
        light.direct += weights[k] * of_probe.direct;
        light.reflected += weights[k] * of_probe.reflected;
        if (has_indirect) light.all += weights[k] * of_probe.all;
      }
      float m = direct(block.transfer, i, lane);
      VertexLight part = VertexLight(m * light.direct, m * light.reflected);
      if (has_indirect) {
        part.indirect += light.all * vec3(indirect(block.transfer, 3u * i, lane), indirect(block.transfer, 3u * i + 1u, lane),
                                          indirect(block.transfer, 3u * i + 2u, lane));
      }
      sum.direct += part.direct;
      sum.indirect += part.indirect;
      if (damped) {
        soft.direct += window * part.direct;
        soft.indirect += window * part.indirect;
      }
    }
  }
  if (damped) sum = VertexLight(withoutRinging(sum.direct, soft.direct), withoutRinging(sum.indirect, soft.indirect));
  vertex_light.at[block.output_ + lane] = sum;
}
