// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What does not change a receiver: tables over a proxy's apparent size, and the light in the form that shading takes.
#pragma once

#include <gloam/sh.h>

#include <vector>

#include "math/sh_light_parts.h"
#include "techniques/proxies/proxies_shared.h"

namespace gloam::proxies {

inline constexpr int kShadowOrder = 4, kIndirectOrder = 3;

/// PX-1: logs of what a proxy leaves visible, as zonal coefficients times sqrt(4 pi / (2 l + 1)) (SH-4).
std::vector<glm::vec4> logVisibilityTable();

/// Solid angle that a proxy alone blocks as each exponential (kExpSeries …) shows it, one table after the other: 4 pi (1 - mean
/// of exp log O). Next to 2 pi (1 - cos) it differs by the exponential's own error (up to 3 %), which then cancels in xi.
std::vector<float> blockedAloneTable();

/// PX-4: mean over the disc of y_l0 of the sphere's normal, seen along +Z (D_l, l = 0 to 2) for a sine of the half-angle in
/// 0 < a <= 1: closed form, and the paper's polynomials.
sh::Zh averageOperator(float sin_half_angle);
sh::Zh averageOperatorFit(float sin_half_angle);

/// PX-5: M_jk = integral of v y_j(s) y_k(normal where s meets the sphere) ds, divided by the disc's solid angle. It is
/// diagonal in m and the same for m and -m: nine of m = 0 (rows 0 to 2), four of m = 1 (rows 1, 2), one of m = 2.
struct ExactOperator {
  float m0[3][3], m1[2][2], m2;
};
ExactOperator exactOperator(float sin_half_angle);
/// Four vec4 an entry, in that order, row by row.
std::vector<glm::vec4> exactOperatorTable();

/// `light` has four bands, windowed or not. In two parts, each is kept from falling below 0 by itself.
ProxyLight proxyLight(const sh::ShRgb& light);
ProxyLight proxyLight(const sh::ShRgb& light, const sh::LightParts& parts);

}  // namespace gloam::proxies
