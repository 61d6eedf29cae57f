// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Virtual lights in an order in which neighbours are near each other and face the same way, so that merging four after four makes
// small clusters (MS-9). Blocks of kSorted lights are sorted each by itself, by a bitonic network.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_shared.h"
#include "vpls/vpls_shared.h"

layout(local_size_x = 256) in;
layout(scalar, set = 0, binding = 0) readonly buffer Rows { VplRow at[]; } rows;
layout(scalar, set = 0, binding = 1) writeonly buffer Lights { SplatLight at[]; } lights;
layout(scalar, set = 0, binding = 2) readonly buffer VplCount { uint value; } vpl_count;
layout(scalar, push_constant) uniform Push { uint capacity; uint network; } push;  // network: a power of 2, kSorted at most

const uint kLanes = 256u, kDark = 0xffffffffu;
shared uint keys[4096];
shared vec3 lows[256], highs[256];

/// Six bits, three apart.
uint spaced(uint v) {
  v = (v | (v << 8)) & 0x0000f00fu;
  v = (v | (v << 4)) & 0x000c30c3u;
  return (v | (v << 2)) & 0x00249249u;
}

/// Side, then place along a Morton curve, then index.
uint keyOf(VplRow row, vec3 low, vec3 size, uint index) {
  vec3 n = abs(row.normal);
  uint axis = n.x > n.y && n.x > n.z ? 0u : (n.y > n.z ? 1u : 2u);
  uint side = 2u * axis + (row.normal[axis] > 0.0 ? 1u : 0u);
  uvec3 cell = uvec3(clamp((row.position - low) / size * 64.0, 0.0, 63.0));
  uint morton = spaced(cell.x) | (spaced(cell.y) << 1) | (spaced(cell.z) << 2);
  return (side << 29) | ((morton >> 1) << 12) | index;
}

void main() {
  uint lane = gl_LocalInvocationID.x, base = gl_WorkGroupID.x * uint(kSorted);
  uint count = min(vpl_count.value - min(base, vpl_count.value), uint(kSorted));
  vec3 low = vec3(1e30), high = vec3(-1e30);
  for (uint i = lane; i < count; i += kLanes) {
    low = min(low, rows.at[base + i].position);
    high = max(high, rows.at[base + i].position);
  }
  lows[lane] = low;
  highs[lane] = high;
  barrier();
  for (uint i = 0u; i < kLanes; ++i) {
    low = min(low, lows[i]);
    high = max(high, highs[i]);
  }
  vec3 size = vec3(max(max(high.x - low.x, high.y - low.y), max(high.z - low.z, 1e-20)));
  for (uint i = lane; i < push.network; i += kLanes) keys[i] = i < count ? keyOf(rows.at[base + i], low, size, i) : kDark;
  barrier();
  for (uint run = 2u; run <= push.network; run *= 2u) {
    for (uint step = run / 2u; step > 0u; step /= 2u) {
      for (uint i = lane; i < push.network / 2u; i += kLanes) {
        uint a = 2u * i - (i & (step - 1u)), b = a + step;
        uint first = keys[a], second = keys[b];
        bool swaps = (first > second) == ((a & run) == 0u);
        keys[a] = swaps ? second : first;
        keys[b] = swaps ? first : second;
      }
      barrier();
    }
  }
  for (uint i = lane; i < push.network && base + i < push.capacity; i += kLanes) {
    SplatLight light = SplatLight(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
    if (keys[i] != kDark) {
      VplRow row = rows.at[base + (keys[i] & 4095u)];
      light = SplatLight(row.position, row.bound, row.normal, row.intensity.r + row.intensity.g + row.intensity.b, row.intensity, 0.0);
    }
    lights.at[base + i] = light;
  }
}
