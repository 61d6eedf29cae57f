// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light in a volume: radiance that a voxel scatters, albedo times M_p . L, and its extinction beside it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/prt/prt_volume_shared.h"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer Voxels { VolumeVoxel at[]; } voxels;
layout(scalar, set = 0, binding = 1) readonly buffer Direct { uint words[]; } transfer_direct;
layout(scalar, set = 0, binding = 2) readonly buffer Indirect { uint words[]; } transfer_indirect;
layout(scalar, set = 0, binding = 3) readonly buffer Lights { vec3 at[]; } light;  // one zero more than coefficients
layout(set = 0, binding = 4) uniform writeonly image3D direct;
layout(set = 0, binding = 5) uniform writeonly image3D indirect;
layout(scalar, push_constant) uniform Push { VolumeParams params; };
layout(constant_id = 0) const uint coefficients = 25u;
layout(constant_id = 1) const bool has_indirect = true;

const float kLargestHalf = 65504.0;

void main() {
  uint block = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x, lane = gl_LocalInvocationID.x;
  uint v = block * 64u + lane;
  if (v >= params.count) return;
  const uint pairs = (coefficients + 1u) / 2u;
  vec3 first = vec3(0.0), further = vec3(0.0);
  for (uint k = 0u; k < pairs; ++k) {
    vec3 even = light.at[2u * k], odd = light.at[2u * k + 1u];
    vec2 t = unpackHalf2x16(transfer_direct.words[(block * pairs + k) * 64u + lane]);
    first += t.x * even + t.y * odd;
    if (!has_indirect) continue;
    for (uint c = 0u; c < 3u; ++c) {
      vec2 m = unpackHalf2x16(transfer_indirect.words[((block * 3u + c) * pairs + k) * 64u + lane]);
      further[c] += m.x * even[c] + m.y * odd[c];
    }
  }
  VolumeVoxel voxel = voxels.at[v];
  uvec3 size = uvec3(imageSize(direct));
  ivec3 place = ivec3(voxel.place % size.x, voxel.place / size.x % size.y, voxel.place / (size.x * size.y));
  vec3 albedo = params.albedo;
  imageStore(direct, place, vec4(clamp(albedo * first, vec3(0.0), vec3(kLargestHalf)), min(voxel.density, kLargestHalf)));
  imageStore(indirect, place, vec4(clamp(albedo * further, vec3(0.0), vec3(kLargestHalf)), 0.0));
}
