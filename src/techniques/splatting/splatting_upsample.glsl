// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-6. A texel's own light, else that between the four coarser texels around it which hold light, of their level or from coarser
// ones: bilinear weights over those that do. What is not lit does not count, and what no coarser texel covers stays empty, so every
// value lies between its sources whatever the levels of neighbours.
//
// The A of a result: 0 empty, else plus, or minus where finer texels have the light of this place and only neighbours ask: 1 + a
// bit for each of four neighbours (right, below left, below, below right) whose surface goes on where this texel's ends (beyond
// the paper, which mixes across an edge that runs along borders of texels).
#ifndef GLOAM_SPLATTING_UPSAMPLE_GLSL
#define GLOAM_SPLATTING_UPSAMPLE_GLSL

layout(set = 0, binding = 1) uniform sampler2D coarse;

// 0: as told above; to look at: 1: blocks, 2: gaps are darkness, and levels add up.
layout(constant_id = 5) const int way = 0;

/// A coarse texel and its eight neighbours, row by row; those beyond the border empty.
struct Parents {
  vec4 at[9];
};

Parents parentsOf(ivec2 parent) {
  ivec2 last = textureSize(coarse, 0) - 1;
  Parents around;
  for (int i = 0; i < 9; ++i) {
    ivec2 next = parent + ivec2(i % 3, i / 3) - 1, inside = clamp(next, ivec2(0), last);
    vec4 texel = texelFetch(coarse, inside, 0);
    if (way == 2 && texel.a <= 0.0) texel = vec4(0.0, 0.0, 0.0, 16.0);
    around.at[i] = next == inside ? texel : vec4(0.0);
  }
  return around;
}

uint bitsOf(vec4 texel) { return uint(max(abs(texel.a) - 1.0, 0.0) + 0.5); }

/// Weight of a neighbour: `own` knows those below and to the right, they know the rest.
float goesOn(vec4 own, vec4 next, uint own_bit, uint next_bit) {
  if (way == 1 || next.a == 0.0) return 0.0;
  if (way == 2) return 1.0;
  return ((own_bit != 0u ? bitsOf(own) & own_bit : bitsOf(next) & next_bit) != 0u) ? 1.0 : 0.0;
}

/// The middle texel for its four children: A 0 where it holds nothing.
void fromCoarser(Parents around, out vec4 children[4]) {
  vec4 own = around.at[4];
  vec4 left = around.at[3], right = around.at[5], above = around.at[1], below = around.at[7];
  left = vec4(left.rgb, 1.0) * (3.0 * goesOn(own, left, 0u, 1u));
  right = vec4(right.rgb, 1.0) * (3.0 * goesOn(own, right, 1u, 0u));
  above = vec4(above.rgb, 1.0) * (3.0 * goesOn(own, above, 0u, 4u));
  below = vec4(below.rgb, 1.0) * (3.0 * goesOn(own, below, 4u, 0u));
  vec4 corners[4];
  corners[0] = vec4(around.at[0].rgb, 1.0) * goesOn(own, around.at[0], 0u, 8u);
  corners[1] = vec4(around.at[2].rgb, 1.0) * goesOn(own, around.at[2], 0u, 2u);
  corners[2] = vec4(around.at[6].rgb, 1.0) * goesOn(own, around.at[6], 2u, 0u);
  corners[3] = vec4(around.at[8].rgb, 1.0) * goesOn(own, around.at[8], 8u, 0u);
  vec4 middle = vec4(own.rgb, 1.0) * 9.0;
  float holds = own.a > 0.0 ? 1.0 : 0.0;
  for (int i = 0; i < 4; ++i) {
    vec4 sum = middle + ((i & 1) != 0 ? right : left) + ((i & 2) != 0 ? below : above) + corners[i];
    children[i] = vec4(sum.rgb / sum.a, 1.0) * holds;
  }
}

#endif
