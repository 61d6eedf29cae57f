// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_VISIBILITY_DEVICE_SHARED_H
#define GLOAM_VISIBILITY_DEVICE_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(visibility)

/// Deepest tree that is built, and what a walk through it has to remember: three boxes a level.
GLOAM_SHARED_CONST int kBoxDepth = 20;
GLOAM_SHARED_CONST int kBoxStack = 64;
/// A child that is a leaf: this, first triangle * 4, number of triangles - 1.
GLOAM_SHARED_CONST uint kBoxLeaf = 0x80000000u;
GLOAM_SHARED_CONST int kLeafTriangles = 4;

/// Four boxes; child 0: there is none.
struct BoxNode {
  vec3 low[4];
  vec3 high[4];
  uint child[4];
};
GLOAM_SHARED_SIZE(BoxNode, 112)

struct BoxTriangle {
  vec3 corner;
  vec3 edge_u;
  vec3 edge_v;
};
GLOAM_SHARED_SIZE(BoxTriangle, 36)

struct SightParams {
  uint point_count;
  uint words;
  uint light_stride;  // words of 32 bits
  uint set_count;
  uint row;  // points a row of work groups
};
GLOAM_SHARED_SIZE(SightParams, 20)

GLOAM_SHARED_END
#endif
