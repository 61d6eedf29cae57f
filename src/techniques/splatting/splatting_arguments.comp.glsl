// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// From counts to dispatches: over a level's queue; over its leaves, once they are all counted; or over those subsplats that ask
// for a set of lights, by chunk of lights.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_shared.h"
#include "vpls/vpls_shared.h"

layout(constant_id = 0) const int of = 0;  // 0 queue, 1 leaves, 2 a set of lights

layout(local_size_x = 1) in;
layout(scalar, set = 0, binding = 0) buffer CountsBlock { Counts value; } counts;
layout(scalar, set = 0, binding = 1) writeonly buffer Arguments { Groups at[]; } arguments;
layout(scalar, set = 0, binding = 2) readonly buffer VplCount { uint value; } vpl_count;
layout(scalar, push_constant) uniform Push { ArgumentsPush value; } push;

Groups groupsOver(uint count) {
  uint groups = (count + uint(kGroup) - 1u) / uint(kGroup);
  return Groups(min(groups, kRowOfGroups), (groups + kRowOfGroups - 1u) / kRowOfGroups, 1u);
}

void main() {
  int level = push.value.level;
  if (of == 0) {
    arguments.at[level] = groupsOver(counts.value.queued[level]);
  } else if (of == 1) {
    uint leaves = counts.value.leaves[level];
    counts.value.first_leaf[level] = counts.value.subsplats;
    counts.value.subsplats += leaves;
    arguments.at[level] = groupsOver(leaves);
    arguments.at[kOverFours + level] = groupsOver((leaves + uint(kEach) - 1u) / uint(kEach));
  } else {
    uint lights = (vpl_count.value + (1u << (2 * level)) - 1u) >> (2 * level);
    Groups groups = groupsOver((counts.value.listed[level] + uint(kEach) - 1u) / uint(kEach));
    for (int chunk = 0; chunk < push.value.chunks; ++chunk) {
      bool any_light = chunk == 0 || uint(chunk * kVplChunk) < lights;
      arguments.at[kOverChunks + push.value.first + chunk] = any_light ? groups : Groups(0u, 1u, 1u);
    }
  }
}
