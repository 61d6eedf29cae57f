// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Entries of the list of pixels that are computed from scratch: those of a square of 2 x 2 on one surface are computed once. Includers
// declare frame_view, depth, normals and push.divisor.
#ifndef GLOAM_PROXIES_QUADS_GLSL
#define GLOAM_PROXIES_QUADS_GLSL
#include "frame/quads.glsl"

/// The middle of the pixels of a list's entry, and the mean of their normals.
struct Middle {
  vec3 position, normal;
};
Middle middleOf(uint packed, ivec2 first) {
  Middle sum = Middle(vec3(0.0), vec3(0.0));
  for (uint i = 0u; i < 4u; ++i) {
    if ((packed >> i & 1u) == 0u) continue;
    ivec2 pixel = pixelOf(first, i);
    Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
    sum.position += ray.origin + ray.direction * eyeDepth(frame_view.view, texelFetch(depth, pixel, 0).x);
    sum.normal += shadingNormal(texelFetch(normals, pixel, 0).xy);
  }
  return Middle(sum.position / float(bitCount(packed & 15u)), normalize(sum.normal));
}
/// Both sides of a list agree on it, wherever in the square the entry's pixels are.
uint tileOf(ivec2 first, uint columns) {
  uvec2 tile = uvec2(max(first, ivec2(0))) / kRepairTile;
  return tile.y * columns + tile.x;
}

#endif
