// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-8 in shaders, orders 5 and 6: as in sh_exp.glsl.
#ifndef GLOAM_MATH_SH_EXP_HIGH_GLSL
#define GLOAM_MATH_SH_EXP_HIGH_GLSL

#include "math/sh_exp.glsl"
#include "math/sh_product_high.glsl"

void shExpHybrid5(const float f[25], out float h[25]) { GLOAM_SH_EXP_HYBRID(5, 25) }
void shExpHybrid6(const float f[36], out float h[36]) { GLOAM_SH_EXP_HYBRID(6, 36) }
void shExpQuadratic5(const float f[25], out float h[25]) { GLOAM_SH_EXP_QUADRATIC(5, 25) }
void shExpQuadratic6(const float f[36], out float h[36]) { GLOAM_SH_EXP_QUADRATIC(6, 36) }
void shExpLinear5(const float f[25], out float h[25]) { GLOAM_SH_EXP_LINEAR(5) }
void shExpLinear6(const float f[36], out float h[36]) { GLOAM_SH_EXP_LINEAR(6) }
void shExpSeries5(const float f[25], int terms, out float h[25]) { GLOAM_SH_EXP_SERIES(5, 25) }
void shExpSeries6(const float f[36], int terms, out float h[36]) { GLOAM_SH_EXP_SERIES(6, 36) }

#endif
