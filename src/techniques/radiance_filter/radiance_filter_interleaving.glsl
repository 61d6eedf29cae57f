// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Which point is which pixel (RF-2). Invocation (x, y, s) is place (x, y) of the tile of set s.
#ifndef GLOAM_RADIANCE_FILTER_INTERLEAVING_GLSL
#define GLOAM_RADIANCE_FILTER_INTERLEAVING_GLSL
#include "techniques/radiance_filter/radiance_filter_shared.h"

bool isBeyondTile(Interleaving i, uvec3 id) { return id.x >= i.tile_width || id.y >= i.tile_height; }
uint pointIndex(Interleaving i, uvec3 id) { return (id.z * i.tile_height + id.y) * i.tile_width + id.x; }
uint setOfPoint(Interleaving i, uvec3 id) { return i.only_set == kEverySet ? id.z : i.only_set; }
ivec2 pixelOfPoint(Interleaving i, uvec3 id) {
  return ivec2(id.x * i.sets_x + id.z % i.sets_x, id.y * i.sets_y + id.z / i.sets_x);
}
bool isInPicture(Interleaving i, ivec2 pixel) { return pixel.x < int(i.width) && pixel.y < int(i.height); }

#endif
