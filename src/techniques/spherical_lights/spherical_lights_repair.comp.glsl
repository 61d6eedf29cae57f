// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-8, the fix-up's second half: points that were lit from scratch give their light to the pixels that they stand for.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D point_direct;
layout(set = 0, binding = 1) uniform sampler2D point_indirect;
layout(scalar, set = 0, binding = 2) readonly buffer Repairs { QuadList list; uint at[]; } repairs;
layout(set = 0, binding = 3, rgba16f) uniform image2D direct_full;
layout(set = 0, binding = 4, rgba16f) uniform image2D indirect_full;
layout(scalar, push_constant) uniform Push { uint divisor; uint capacity; } push;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  uint entry = uint(texel.y) * kPointColumns + uint(texel.x);
  if (entry >= min(repairs.list.count_and_one - 1u, push.capacity)) return;
  uint packed = repairs.at[entry];
  ivec2 first = 2 * ivec2(packed >> 5 & 0x1fffu, packed >> 18) - int(push.divisor / 2u);
  vec4 lit = texelFetch(point_direct, texel, 0), sent = texelFetch(point_indirect, texel, 0);
  for (uint i = 0u; i < 4u; ++i) {
    if ((packed >> i & 1u) == 0u) continue;
    imageStore(direct_full, first + ivec2(i & 1u, i >> 1), lit);
    imageStore(indirect_full, first + ivec2(i & 1u, i >> 1), sent);
  }
}
