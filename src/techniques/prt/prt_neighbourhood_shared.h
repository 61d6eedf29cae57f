// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_PRT_NEIGHBOURHOOD_SHARED_H
#define GLOAM_PRT_NEIGHBOURHOOD_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(prt)

/// Share of the way from a grid's centre to its border, at the end of it, over which its say fades out.
GLOAM_SHARED_CONST float kNeighbourhoodFade = 0.2f;

/// A grid of radiance, turned to the axes of who reads it.
struct NeighbourhoodGrid {
  mat4x3 way_from_place;  // from the reader's coordinates to the carrier's, from the grid's centre on
  vec3 spacing;           // of the grid's points, as NeighbourhoodTransfer has them
  vec3 core;
  vec3 growth;
  vec3 half_size;  // from the centre to the border
  uvec3 size;
  uint first_word;  // of its radiance
  uint carrier;     // whose grid it is
};
GLOAM_SHARED_SIZE(NeighbourhoodGrid, 116)

/// One grid's matrices times the light.
struct NeighbourhoodPoints {
  uint points;
  uint first_word;  // where its radiance goes
  uint first_row;   // of those that this dispatch makes
};
GLOAM_SHARED_SIZE(NeighbourhoodPoints, 12)

/// One grid's radiance turned to a reader's axes.
struct NeighbourhoodTurn {
  uint points;
  uint first_in;
  uint first_out;
  uint first_rotation;  // (2l + 1)^2 numbers a band, row after row
};
GLOAM_SHARED_SIZE(NeighbourhoodTurn, 16)

/// A lit instance of baked vertices, and the grids that it stands in.
struct NeighbourhoodReader {
  uint first_output;  // of its vertices' light
  uint vertex_count;
  uint first_position;
  uint first_light;  // of its light, as many coefficients as the radiance has
  uint first_grid;
  uint grid_count;
};
GLOAM_SHARED_SIZE(NeighbourhoodReader, 24)

struct NeighbourhoodVertices {
  uint block_count;
  uint reader_count;
  float exposure;
};
GLOAM_SHARED_SIZE(NeighbourhoodVertices, 12)

struct NeighbourhoodPixels {
  uint grid_count;
  float exposure;
};
GLOAM_SHARED_SIZE(NeighbourhoodPixels, 8)

GLOAM_SHARED_END
#endif
