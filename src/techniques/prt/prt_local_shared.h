// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_PRT_LOCAL_SHARED_H
#define GLOAM_PRT_LOCAL_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(prt)

/// Most points at which an object's light is sampled.
GLOAM_SHARED_CONST int kMostLocalPoints = 16;

/// An instance that is lit by probes, in the order of TransferBuffers::litInstances().
struct LocalRow {
  mat4x3 world_from_object;
  mat3 object_from_world;  // its rotation alone
  vec3 middle;             // in the world: where texels are taken to be
  uint first_output;
  uint first_vertex;  // of the scene's positions; kUnbaked: points are texels
  uint first_job;     // of its probes' light, in its own axes
  uint first_probe;
  float softness;  // squared distance that is added to all
};
GLOAM_SHARED_SIZE(LocalRow, 116)

struct LocalVerticesParams {
  uint block_count;
  uint lamp_count;
  uint lamps_direct;  // 1: they shine through transfer; 0: their direct light is left to shadow maps
  float band[6];      // factors of a window
};
GLOAM_SHARED_SIZE(LocalVerticesParams, 36)

GLOAM_SHARED_END
#endif
