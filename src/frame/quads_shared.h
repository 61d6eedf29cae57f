// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_FRAME_QUADS_SHARED_H
#define GLOAM_FRAME_QUADS_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(frame)

/// Head of a list of squares of 2 x 2 pixels (frame/quads.glsl): arguments of a dispatch over them, then how many there are plus one.
struct QuadList {
  uint groups_x;
  uint groups_y;
  uint groups_z;
  uint count_and_one;
};
GLOAM_SHARED_SIZE(QuadList, 16)

/// Of the pass that brings receivers' light to all pixels, and lists those that it does not fit.
struct UpsampleParams {
  uint divisor;
  uint capacity;  // of the list
};
GLOAM_SHARED_SIZE(UpsampleParams, 8)
/// Of the pass that looks for listed pixels' light among more receivers.
struct WidenParams {
  uint divisor;
  uint capacity;         // of the list that it reads
  uint repair_capacity;  // of the list that it writes
};
GLOAM_SHARED_SIZE(WidenParams, 12)

GLOAM_SHARED_END
#endif
