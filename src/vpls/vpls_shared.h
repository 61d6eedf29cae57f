// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_VPLS_SHARED_H
#define GLOAM_VPLS_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(vpls)

/// A virtual point light: a small diffuse surface that sends intensity * max(0, cosine to its normal), in W/sr.
struct VplRow {
  vec3 position;
  float bound;  // squared metres: its area / pi. Nearer than that counts as that near
  vec3 normal;  // geometric, on the side that the lamp lights
  float unused;
  vec3 intensity;  // flux / pi
  float unused_too;
};
GLOAM_SHARED_SIZE(VplRow, 48)

/// Rows come in whole chunks, the last filled up with rows that send nothing: as many as a shader takes from one
/// uniform block. Chunks begin where blocks may begin on any device.
GLOAM_SHARED_CONST int kVplChunk = 64;

/// Where in the atlas a map stands, and which virtual lights are made of it.
struct MapPlace {
  ivec2 corner;  // texels
  int size;
  int grid;  // cells a side
  uint first;  // of its grid * grid virtual lights; by kGrid as many follow, for what cells hold besides
  uint map;
};
GLOAM_SHARED_SIZE(MapPlace, 24)

GLOAM_SHARED_END
#endif
