// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The box round each tile's receivers.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/proxies/proxies_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D receiver_position;
layout(scalar, set = 0, binding = 1) writeonly buffer Bounds { TileBounds at[]; } bounds;

void main() {
  ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = textureSize(receiver_position, 0);
  ivec2 tiles = (size + int(kTileSize) - 1) / int(kTileSize);
  if (any(greaterThanEqual(tile, tiles))) return;
  TileBounds box = TileBounds(vec3(3e38), vec3(-3e38));
  ivec2 first = tile * int(kTileSize);
  for (int i = 0; i < int(kTileSize * kTileSize); ++i) {
    ivec2 place = min(first + ivec2(i % int(kTileSize), i / int(kTileSize)), size - 1);
    vec4 p = texelFetch(receiver_position, place, 0);
    bool counts = p.w > 0.0;
    box.low = counts ? min(box.low, p.xyz) : box.low;
    box.high = counts ? max(box.high, p.xyz) : box.high;
  }
  bounds.at[tile.y * tiles.x + tile.x] = box;
}
