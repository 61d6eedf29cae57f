// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_GPU_TEST_SHARED_H
#define GLOAM_GPU_TEST_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(gpu_test)

struct Inner {
  vec3 axis;
  float radius;
  uvec2 ids;
};
GLOAM_SHARED_SIZE(Inner, 24)

struct Record {
  vec3 position;
  vec2 uv;
  mat3 frame;
  Inner inner[2];
  uint flags;
  mat4 world_from_object;
};
GLOAM_SHARED_SIZE(Record, 172)

struct FillParams {
  vec2 scale;
  float offset;
};
GLOAM_SHARED_SIZE(FillParams, 12)

struct CountParams {
  uint count;
  uint add;
};
GLOAM_SHARED_SIZE(CountParams, 8)

GLOAM_SHARED_CONST uint kGroupSize = 64;

GLOAM_SHARED_END
#endif
