// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_PRT_VOLUME_SHARED_H
#define GLOAM_PRT_VOLUME_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(prt)

/// A filled voxel. Its transfer are halves, two a word: word w of voxel v of block b (64 voxels) stands at
/// (b * words + w) * 64 + v; `direct` has one run of order^2 values, `indirect` one a colour, each from a word of its own.
struct VolumeVoxel {
  uint place;  // (z * height + y) * width + x
  float density;
};
GLOAM_SHARED_SIZE(VolumeVoxel, 8)

struct VolumeParams {
  vec3 albedo;
  uint count;
};
GLOAM_SHARED_SIZE(VolumeParams, 16)

GLOAM_SHARED_END
#endif
