// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// MS-6. A texel's own light, else that between the four coarser texels around it which hold light, of their level or from coarser
// ones: bilinear weights over those that do. What is not lit does not count, and what no coarser texel covers stays empty, so every
// value lies between its sources whatever the levels of neighbours.
//
// The A of a result: 0 empty, else plus, or minus where finer texels have the light of this place and only neighbours ask, 1 + bits of the eight neighbours whose surface goes on where this texel's ends (beyond the
// paper, which mixes across an edge that runs along borders of texels).
#ifndef GLOAM_SPLATTING_UPSAMPLE_GLSL
#define GLOAM_SPLATTING_UPSAMPLE_GLSL

/// The bit of a neighbour, its steps -1 to 1.
uint neighbourBit(ivec2 step) {
  int i = (step.y + 1) * 3 + step.x + 1;
  return 1u << uint(i > 4 ? i - 1 : i);
}

// 0: as told above; to look at: 1: blocks, 2: gaps are darkness, and levels add up.
layout(constant_id = 5) const int way = 0;

/// A: 0 where the texel's parent holds nothing.
vec4 fromCoarser(sampler2D coarse, ivec2 at) {
  ivec2 parent = at >> 1, step = (at & 1) * 2 - 1, last = textureSize(coarse, 0) - 1;
  vec4 own = texelFetch(coarse, parent, 0);
  if (way == 2) own = vec4(max(own.rgb, vec3(0.0)) * (own.a > 0.0 ? 1.0 : 0.0), 1.0 + 255.0);
  uint bits = way != 1 ? uint(max(own.a - 1.0, 0.0) + 0.5) : 0u;
  vec4 sum = vec4(own.rgb, 1.0) * 9.0;
  ivec2 steps[3] = ivec2[3](ivec2(step.x, 0), ivec2(0, step.y), step);
  for (int i = 0; i < 3; ++i) {
    ivec2 next = parent + steps[i];
    vec4 texel = texelFetch(coarse, clamp(next, ivec2(0), last), 0);
    bool counts = texel.a != 0.0 && (bits & neighbourBit(steps[i])) != 0u && next == clamp(next, ivec2(0), last);
    if (way == 2 && texel.a <= 0.0) texel.rgb = vec3(0.0);
    sum += vec4(texel.rgb, 1.0) * (counts || way == 2 ? (i == 2 ? 1.0 : 3.0) : 0.0);
  }
  return own.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0);
}

#endif
