// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sums over the proxies of a tile (PX-7), in their own order. Includers declare the constant by_lanes, the buffer proxies of words and the
// buffer bits besides what proxies_gather.glsl asks for, and have all lanes run.
#ifndef GLOAM_PROXIES_TILE_LIST_GLSL
#define GLOAM_PROXIES_TILE_LIST_GLSL
#include "frame/lanes.glsl"
#include "techniques/proxies/proxies_gather.glsl"

ProxyRow proxyAt(uint i) {
  Eight row;
  GLOAM_READ_EIGHT(row, proxies, 8u * i)
  return ProxyRow(row.a.xyz, row.a.w, row.b.xyz, row.b.w);
}

/// `first`: the tile's first word of bits. One loop over all words, whose body runs once a proxy: the software driver goes through
/// a loop's body once more than it has to, which a loop a word would multiply. Proxies of another lane's tile do not reach.
Gathered gatherTile(vec3 position, vec3 normal, uint first) {
  Gathered sum = Gathered(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  vec3 leaving[9] = light.row.leaving;
  uint word = 0u, left = 0u;
  while (left == 0u && word < push.params.words) left = bitsOfLanes(bits.at[first + word++]);
  if (left == 0u) return sum;
  do {
    ProxyRow proxy = proxyAt((word - 1u) * 32u + uint(findLSB(left)));
    if (reaches(position, proxy)) addProxy(sum, position, normal, proxy, leaving);
    left &= left - 1u;
    while (left == 0u && word < push.params.words) left = bitsOfLanes(bits.at[first + word++]);
  } while (left != 0u);
  return sum;
}

#endif
