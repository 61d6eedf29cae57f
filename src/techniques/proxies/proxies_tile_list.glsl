// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sums over the proxies of a tile (PX-7), in their own order. Includers declare the buffer bits besides what proxies_gather.glsl
// asks for.
#ifndef GLOAM_PROXIES_TILE_LIST_GLSL
#define GLOAM_PROXIES_TILE_LIST_GLSL
#include "techniques/proxies/proxies_gather.glsl"

/// `first`: the tile's first word of bits. One loop over all words, whose body runs once a proxy: the software driver goes through
/// a loop's body once more than it has to, which a loop a word would multiply.
Gathered gatherTile(vec3 position, vec3 normal, uint first) {
  Gathered sum = Gathered(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  uint word = 0u, left = 0u;
  while (left == 0u && word < push.params.words) left = bits.at[first + word++];
  if (left == 0u) return sum;
  do {
    uint i = (word - 1u) * 32u + uint(findLSB(left));
    if (reaches(position, i)) addProxy(sum, position, normal, i);
    left &= left - 1u;
    while (left == 0u && word < push.params.words) left = bits.at[first + word++];
  } while (left != 0u);
  return sum;
}

#endif
