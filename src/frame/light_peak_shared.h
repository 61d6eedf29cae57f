// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_FRAME_LIGHT_PEAK_SHARED_H
#define GLOAM_FRAME_LIGHT_PEAK_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(frame)

/// The sharpest peak of distant light (math/sh_light_parts.h), as light from one direction.
struct LightPeak {
  vec3 direction;
  vec3 irradiance;  // on a plane that faces it; 0: no peak
  float basis[16];  // y(direction): its product with four bands of visibility is what is left of the peak
};
GLOAM_SHARED_SIZE(LightPeak, 88)

GLOAM_SHARED_END
#endif
