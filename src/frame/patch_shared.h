// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_FRAME_PATCH_SHARED_H
#define GLOAM_FRAME_PATCH_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(frame)

/// A rectangle of something without spheres (frame/emission.h, Patch).
struct PatchRow {
  vec3 center;
  vec3 half_u;
  vec3 half_v;
  vec3 normal;
  vec3 albedo;
};
GLOAM_SHARED_SIZE(PatchRow, 60)

GLOAM_SHARED_END
#endif
