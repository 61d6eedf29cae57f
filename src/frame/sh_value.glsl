// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// An RGB function in spherical harmonics at a direction, for an order that is a specialisation constant: what
// is beyond it costs nothing.
#ifndef GLOAM_FRAME_SH_VALUE_GLSL
#define GLOAM_FRAME_SH_VALUE_GLSL
#include "math/sh.glsl"

const float kShNoFactors[6] = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0};

#define GLOAM_SH_VALUE(order, count)                       \
  {                                                        \
    float y[count];                                        \
    shEvaluate##order(direction, y);                       \
    return GLOAM_SH_BANDS_##order(sh, y, kShNoFactors);    \
  }

vec3 shValue(int order, vec3 sh[36], vec3 direction) {
  if (order <= 3) GLOAM_SH_VALUE(3, 9)
  if (order == 4) GLOAM_SH_VALUE(4, 16)
  if (order == 5) GLOAM_SH_VALUE(5, 25)
  GLOAM_SH_VALUE(6, 36)
}

#endif
