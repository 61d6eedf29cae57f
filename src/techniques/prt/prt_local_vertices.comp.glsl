// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A vertex's irradiance under local light: its transfer vectors times the light of its object's probes, blended by weight
// at the vertex (Sloan, Kautz, Snyder 2002, section 4: incident lighting L_p), and of the lamps as the vertex itself sees them.
// Light that other surfaces reflect is indirect, the first time it arrives too. One work group a block of vertices.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/lamp.glsl"
#include "frame/probe_shared.h"
#include "math/sh.glsl"
#include "techniques/prt/prt_local_shared.h"
#include "techniques/prt/prt_pairs.glsl"
#include "techniques/prt/prt_ringing.glsl"
#include "techniques/prt/prt_shared.h"

layout(constant_id = 0) const int order = 5;
layout(constant_id = 1) const bool has_indirect = true;
layout(constant_id = 2) const bool half_float = false;
layout(constant_id = 3) const bool damped = false;  // a window of the light is mixed in where ringing shows
layout(constant_id = 4) const int points = 4;

layout(local_size_x = kBlockVertices) in;
layout(scalar, set = 0, binding = 0) readonly buffer Blocks { VertexBlock at[]; } blocks;
layout(scalar, set = 0, binding = 1) readonly buffer TransferDirect { uint at[]; } transfer_direct;
layout(scalar, set = 0, binding = 2) readonly buffer TransferIndirect { uint at[]; } transfer_indirect;
layout(scalar, set = 0, binding = 3) readonly buffer Lights { ProbeLight at[]; } lights;
layout(scalar, set = 0, binding = 4) writeonly buffer VertexLights { VertexLight at[]; } vertex_light;
layout(scalar, set = 0, binding = 6) readonly buffer Places { vec3 at[]; } probe_places;
layout(scalar, set = 0, binding = 7) readonly buffer Trust { float at[]; } trust;
layout(scalar, set = 0, binding = 8) readonly buffer Positions { vec3 at[]; } positions;
layout(scalar, set = 0, binding = 9) readonly buffer Normals { vec3 at[]; } normals;
layout(scalar, set = 0, binding = 10) readonly buffer Lamps { LightRow at[]; } lamps;
layout(scalar, set = 0, binding = 11) readonly buffer LampsSeen { float at[]; } lamps_seen;  // [probe][lamp]
layout(scalar, push_constant) uniform Push { LocalVerticesParams params; } push;
#include "techniques/prt/prt_local.glsl"
layout(scalar, set = 0, binding = 5) readonly buffer Rows { LocalRow at[]; } rows;

const uint kCoefficients = uint(order * order);
const float kPi = 3.14159265;
#include "techniques/prt/prt_values.glsl"
#include "techniques/prt/prt_local_lamps.glsl"

void main() {
  uint number = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (number >= push.params.block_count) return;
  VertexBlock block = blocks.at[number];
  uint lane = gl_LocalInvocationID.x;
  if (lane >= block.count) return;
  uint lit = block.light / kCoefficients;
  LocalRow row = rows.at[lit];
  vec3 place = row.middle, normal = vec3(0.0);
  if (row.first_vertex != kUnbaked) {
    uint vertex = row.first_vertex + block.output_ + lane - row.first_output;
    place = row.world_from_object * vec4(positions.at[vertex], 1.0);
    normal = normals.at[vertex];
  }
  float weights[kMostLocalPoints];
  localWeights(row, place, weights);

  VertexLight sum = VertexLight(vec3(0.0), vec3(0.0)), soft = sum;
  uint i = 0u;
  for (int band = 0; band < order; ++band) {
    float window = 0.5 + 0.5 * cos(kPi * float(band) / float(order));
    for (uint end = uint((band + 1) * (band + 1)); i < end; ++i) {
      ProbeLight light = ProbeLight(vec3(0.0), vec3(0.0));
      for (int k = 0; k < points; ++k) {
        ProbeLight of_probe = lights.at[(row.first_job + uint(k)) * kCoefficients + i];
        light.direct += weights[k] * of_probe.direct;
        light.reflected += weights[k] * of_probe.reflected;
      }
      float m = direct(block.transfer, i, lane);
      VertexLight part = VertexLight(m * light.direct, m * light.reflected);
      if (has_indirect) part.indirect += (light.direct + light.reflected) * indirect(block.transfer, i, lane);
      sum.direct += part.direct;
      sum.indirect += part.indirect;
      if (damped) {
        soft.direct += window * part.direct;
        soft.indirect += window * part.indirect;
      }
    }
  }
  vec3 of_lamps = vec3(0.0);
  if (push.params.lamp_count > 0u) of_lamps = lampLight(row, block.transfer, lane, place, normal, weights, sum.indirect, soft.indirect);
  if (damped) sum = VertexLight(withoutRinging(sum.direct, soft.direct), withoutRinging(sum.indirect, soft.indirect));
  sum.direct += of_lamps;
  vertex_light.at[block.output_ + lane] = sum;
}
