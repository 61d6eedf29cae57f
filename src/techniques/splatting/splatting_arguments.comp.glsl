// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// From counts to dispatches: of a level's queue, or, once all are counted, of every level's leaves and of every chunk of lights.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_shared.h"
#include "vpls/vpls_shared.h"

layout(constant_id = 0) const bool at_the_end = false;

layout(local_size_x = 1) in;
layout(scalar, set = 0, binding = 0) buffer CountsBlock { Counts value; } counts;
layout(scalar, set = 0, binding = 1) writeonly buffer Arguments { Groups at[]; } arguments;
layout(scalar, set = 0, binding = 2) readonly buffer VplCount { uint value; } vpl_count;
layout(scalar, push_constant) uniform Push {
  int level;       // whose queue it is; at the end: the coarsest
  int finest;      // the finest level, whose queue holds leaves where pixel_leaves
  int pixel_leaves;
  int chunks;
} push;

Groups groupsOver(uint count) {
  uint groups = (count + uint(kGroup) - 1u) / uint(kGroup);
  return Groups(min(groups, kRowOfGroups), (groups + kRowOfGroups - 1u) / kRowOfGroups, 1u);
}

void main() {
  if (!at_the_end) {
    arguments.at[push.level] = groupsOver(counts.value.queued[push.level]);
    return;
  }
  if (push.pixel_leaves != 0) counts.value.leaves[push.finest] = counts.value.queued[push.finest];
  uint sum = 0u;
  for (int level = push.level; level >= push.finest; --level) {
    counts.value.first_leaf[level] = sum;
    arguments.at[level] = groupsOver(counts.value.leaves[level]);
    sum += counts.value.leaves[level];
  }
  counts.value.subsplats = sum;
  for (int chunk = 0; chunk < push.chunks; ++chunk) {
    bool any_light = chunk == 0 || uint(chunk * kVplChunk) < vpl_count.value;
    arguments.at[kMostLevels + chunk] = any_light ? groupsOver(sum) : Groups(0u, 1u, 1u);
  }
}
