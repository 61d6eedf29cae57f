// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_IRRADIANCE_SHARED_H
#define GLOAM_IRRADIANCE_SHARED_H
#include "gpu/shared_types.h"
GLOAM_SHARED_BEGIN(irradiance)

/// Light convolved with the clamped cosine: a plane with normal n receives the sum of sh[i] y_i(n).
struct IrradianceRow {
  vec3 sh[36];
};
GLOAM_SHARED_SIZE(IrradianceRow, 432)

GLOAM_SHARED_END
#endif
