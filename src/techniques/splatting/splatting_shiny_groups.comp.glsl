// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// From the number of pixels to a dispatch over them, kEach an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_shared.h"

layout(local_size_x = 1) in;
layout(scalar, set = 0, binding = 0) readonly buffer CountBlock { uint value; } count;
layout(scalar, set = 0, binding = 1) writeonly buffer GroupsBlock { Groups value; } groups;

void main() {
  uint all = (count.value + uint(kGroup * kEach) - 1u) / uint(kGroup * kEach);
  groups.value = Groups(min(all, kRowOfGroups), (all + kRowOfGroups - 1u) / kRowOfGroups, 1u);
}
