// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A vertex's irradiance: its transfer vectors times its object's light. One work group a block of vertices.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/prt/prt_ringing.glsl"
#include "techniques/prt/prt_shared.h"

layout(constant_id = 0) const int coefficients = 25;
layout(constant_id = 1) const bool has_indirect = true;
layout(constant_id = 2) const bool half_float = false;
layout(constant_id = 3) const bool damped = false;  // the same lights windowed follow, where ringing is to be damped

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer Blocks { VertexBlock at[]; } blocks;
layout(scalar, set = 0, binding = 1) readonly buffer TransferDirect { uint at[]; } transfer_direct;
layout(scalar, set = 0, binding = 2) readonly buffer TransferIndirect { uint at[]; } transfer_indirect;
layout(scalar, set = 0, binding = 3) readonly buffer Lights { vec3 at[]; } lights;
layout(scalar, set = 0, binding = 4) writeonly buffer VertexLights { VertexLight at[]; } vertex_light;
layout(scalar, push_constant) uniform Push { VerticesParams params; } push;

/// Value i of a lane's vertex. Halves stand two a word.
float direct(uint block, uint i, uint lane) {
  if (!half_float) return uintBitsToFloat(transfer_direct.at[(block * uint(coefficients) + i) * kBlockVertices + lane]);
  uint words = uint(coefficients + 1) / 2u;
  return unpackHalf2x16(transfer_direct.at[(block * words + (i >> 1)) * kBlockVertices + lane])[i & 1u];
}
float indirect(uint block, uint i, uint lane) {
  if (!half_float) return uintBitsToFloat(transfer_indirect.at[(block * 3u * uint(coefficients) + i) * kBlockVertices + lane]);
  uint words = uint(3 * coefficients + 1) / 2u;
  return unpackHalf2x16(transfer_indirect.at[(block * words + (i >> 1)) * kBlockVertices + lane])[i & 1u];
}

void main() {
  uint number = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (number >= push.params.block_count) return;
  VertexBlock block = blocks.at[number];
  uint lane = gl_LocalInvocationID.x;
  if (lane >= block.count) return;
  VertexLight sum = VertexLight(vec3(0.0), vec3(0.0)), soft = sum;
  for (uint i = 0u; i < uint(coefficients); ++i) {
    vec3 light = lights.at[block.light + i], soft_light = vec3(0.0);
    float m = direct(block.transfer, i, lane);
    sum.direct += light * m;
    if (damped) {
      soft_light = lights.at[push.params.first_damped + block.light + i];
      soft.direct += soft_light * m;
    }
    if (has_indirect) {
      vec3 bounced = vec3(indirect(block.transfer, 3u * i, lane), indirect(block.transfer, 3u * i + 1u, lane),
                          indirect(block.transfer, 3u * i + 2u, lane));
      sum.indirect += light * bounced;
      if (damped) soft.indirect += soft_light * bounced;
    }
  }
  if (damped) sum = VertexLight(withoutRinging(sum.direct, soft.direct), withoutRinging(sum.indirect, soft.indirect));
  vertex_light.at[block.output_ + lane] = sum;
}
