// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Rows of a buffer that all lanes of a subgroup read alike. A software driver pays for each lane's load; there each of eight lanes reads one
// word and gives it to all. Asks that all lanes run, for the same rows. Includers enable GL_KHR_shader_subgroup_shuffle and declare the constant by_lanes, and
// such buffers as words.
#ifndef GLOAM_FRAME_LANES_GLSL
#define GLOAM_FRAME_LANES_GLSL
#include "frame/patch_shared.h"

struct Eight {
  vec4 a, b;
};
#define GLOAM_READ_EIGHT(eight, words, first)                                                                                   \
  {                                                                                                                             \
    uint from = first;                                                                                                          \
    uvec4 a, b;                                                                                                                 \
    if (by_lanes) {                                                                                                             \
      uint mine = words.at[from + (gl_SubgroupInvocationID & 7u)];                                                              \
      a = uvec4(subgroupShuffle(mine, 0u), subgroupShuffle(mine, 1u), subgroupShuffle(mine, 2u), subgroupShuffle(mine, 3u)); \
      b = uvec4(subgroupShuffle(mine, 4u), subgroupShuffle(mine, 5u), subgroupShuffle(mine, 6u), subgroupShuffle(mine, 7u)); \
    } else {                                                                                                                    \
      a = uvec4(words.at[from], words.at[from + 1u], words.at[from + 2u], words.at[from + 3u]);                                 \
      b = uvec4(words.at[from + 4u], words.at[from + 5u], words.at[from + 6u], words.at[from + 7u]);                            \
    }                                                                                                                           \
    eight = Eight(uintBitsToFloat(a), uintBitsToFloat(b));                                                                      \
  }

/// A PatchRow.
#define GLOAM_READ_PATCH(row, words, j)                                                             \
  {                                                                                                 \
    Eight p, q;                                                                                     \
    GLOAM_READ_EIGHT(p, words, 15u * (j))                                                           \
    GLOAM_READ_EIGHT(q, words, 15u * (j) + 7u)                                                      \
    row = PatchRow(p.a.xyz, vec3(p.a.w, p.b.xy), vec3(p.b.zw, q.a.y), vec3(q.a.zw, q.b.x), q.b.yzw); \
  }

/// All bits that any of eight lanes has, where rows are read together; so lanes with lists of their own go through one.
uint bitsOfLanes(uint mine) {
  if (!by_lanes) return mine;
  uvec4 a = uvec4(subgroupShuffle(mine, 0u), subgroupShuffle(mine, 1u), subgroupShuffle(mine, 2u), subgroupShuffle(mine, 3u));
  a |= uvec4(subgroupShuffle(mine, 4u), subgroupShuffle(mine, 5u), subgroupShuffle(mine, 6u), subgroupShuffle(mine, 7u));
  return a.x | a.y | a.z | a.w;
}

#endif
