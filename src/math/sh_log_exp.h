// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-7, SH-8: logarithm and exponential of functions on the sphere (Ren et al. 2006; Sloan et al. 2007, eq. 4), with
// which many blockers cost a sum each and one exponential: visibility behind all = exp(sum of log(1 - disc_i)).
//
// Both belong to the algebra of the truncated product *: log f = log(M_f) 1 and exp f = exp(M_f) 1 with M_f the
// product matrix of f, 1 the constant function. Conventions and errors as in gloam/sh.h. The exponentials of orders
// 3 to 6 stand in math/sh_exp.glsl under the same names; docs/sh.md has the error and cost of each.
#pragma once

#include <gloam/sh.h>

#include <span>
#include <vector>

namespace gloam::sh {

// ---- SH-7: logarithm ----

/// Eigenvalues of M_f below this part of the greatest are raised to it: a blocker's log ends at ln 0.02 = -3.9.
inline constexpr float kLogClamp = 0.02f;

/// Logarithm of a function whose product matrix has a positive eigenvalue, else Error: log f = R^T diag(log t / (t -
/// 1)) R (f - 1), M_f = R^T diag(t) R, t clamped from below at `clamp` (in 0 to 1) times the greatest. 5 to 80 us.
Sh logarithm(const Sh& f, float clamp = kLogClamp);
/// The same for a function about +Z; much faster.
Zh logarithmZonal(const Zh& f, float clamp = kLogClamp);
/// Logarithm of 1 outside the cone of that half-angle about +Z and 0 in it: what a sphere leaves visible. Error where
/// that is less than a thousandth of all directions.
Zh logBlocker(int order, float half_angle_rad, float clamp = kLogClamp);

/// logBlocker of spheres, tabulated over alpha, the sine of the half-angle, from 0 (nothing there) to 1 (the sphere
/// touches). Entry i of n stands at logBlockerCoordinate(alpha) = i / (n - 1): nearly proportional to alpha, yet
/// smooth at 1 as well; between entries it is linear. 256 entries are within 0.3 % (1.7 % at orders 5 and 6) of it.
struct LogBlockerTable {
  int order = 0;
  std::vector<Zh> entries;

  /// alpha is clamped to 0 … 1.
  Zh at(float alpha) const;
};
/// 2 to 65,536 entries, else Error.
LogBlockerTable makeLogBlockerTable(int order, int entries = 256, float clamp = kLogClamp);
/// sqrt(2) sin(theta / 2) for alpha = sin(theta): 0 … 1. In shaders: shLogBlockerCoordinate (sh_log_blocker.glsl).
float logBlockerCoordinate(float alpha);
/// The alpha that has this coordinate.
float logBlockerAlpha(float coordinate);

// ---- SH-8: exponential ----
//
// All isolate the mean: exp f = exp(f_0 / sqrt(4 pi)) exp(f^), f^ = f without coefficient 0; so a constant added to f
// scales the result exactly. HYB and quadratic shorten f as a whole where |f^| > 32: as many spheres one behind the
// other as that takes look the same when there are fewer, and nothing overflows.

enum class ExpMethod { kSeries, kLinear, kHybrid, kQuadratic };

/// HYB where nothing else is said; kSeries takes 9 terms.
Sh exponential(const Sh& f, ExpMethod method = ExpMethod::kHybrid);
/// PS: 1 + f^ + f^ * f^ / 2 + … up to power `terms` (at least 1, else Error); terms - 1 products. Good for |f^| < 2.
Sh expSeries(const Sh& f, int terms = 9);
/// OL: a 1 + b f^, a and b tabulated over |f^| up to 8; no product. The coarsest.
Sh expLinear(const Sh& f);
/// HYB: a 1 + b f^ of f^ / 2^p with |f^| / 2^p <= 0.25, squared p times.
Sh expHybrid(const Sh& f);
/// The same with a 1 + b f^ + c f^ * f^, |f^| / 2^p <= 2 (1 at orders 5, 6): p + 1 products, of which p is less by 3; one more in the
/// last quarter of that range, where it goes over to p + 1 squarings: it does not jump, as HYB does.
Sh expQuadratic(const Sh& f);
/// exp(M_f) 1 by eigenvalues in double precision, what the others approximate. Slow.
Sh expNumeric(const Sh& f);

/// Of many functions (SIMD; planes as in gloam/sh.h). Items that need few squarings wait for their neighbours.
void expHybridMany(int order, std::size_t count, std::span<const float> f, std::span<float> out,
                   std::size_t stride);
void expQuadraticMany(int order, std::size_t count, std::span<const float> f, std::span<float> out,
                      std::size_t stride);

}  // namespace gloam::sh
