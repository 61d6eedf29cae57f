// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Which proxies reach a tile (PX-7): a bit each, so that receivers meet them in their own order, whoever runs first. A proxy
// reaches as far as it looks larger than least_sine; what the receiver rule makes of it is never larger than r / d.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/proxies/proxies_shared.h"

layout(constant_id = 0) const bool repairs = false;  // bounds as proxies_repair_bounds keeps them

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) readonly buffer Bounds { uint at[]; } bounds;
layout(scalar, set = 0, binding = 1) readonly buffer Proxies { ProxyRow at[]; } proxies;
layout(scalar, set = 0, binding = 2) writeonly buffer Bits { uint at[]; } bits;
layout(scalar, push_constant) uniform Push { TileParams params; } push;

float unordered(uint word) { return uintBitsToFloat((word & 0x80000000u) != 0u ? word & 0x7fffffffu : ~word); }
vec3 corner(uint first) {
  uvec3 words = uvec3(bounds.at[first], bounds.at[first + 1u], bounds.at[first + 2u]);
  return repairs ? vec3(unordered(words.x), unordered(words.y), unordered(words.z)) : uintBitsToFloat(words);
}

void main() {
  uint tile = gl_GlobalInvocationID.x, word = gl_WorkGroupID.y;
  if (tile >= push.params.tiles) return;
  vec3 a = corner(6u * tile), b = corner(6u * tile + 3u);
  TileBounds box = repairs ? TileBounds(-b, a) : TileBounds(a, b);  // without pixels: not a number
  float least2 = push.params.least_sine * push.params.least_sine;
  uint mask = 0u;
  for (uint bit = 0u; box.low.x <= box.high.x && bit < 32u; ++bit) {
    uint i = word * 32u + bit;
    if (i >= push.params.proxies) break;
    vec3 center = proxies.at[i].center;
    float radius = proxies.at[i].radius;
    vec3 away = center - clamp(center, box.low, box.high);
    mask |= least2 * dot(away, away) < radius * radius ? 1u << bit : 0u;
  }
  bits.at[tile * gl_NumWorkGroups.y + word] = mask;
}
