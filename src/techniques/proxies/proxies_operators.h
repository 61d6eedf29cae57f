// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How far PX-3 and PX-4 are from PX-5, and PX-4's polynomials from its closed form: the figures that the paper prints.
#pragma once

#include <gloam/sh.h>

#include <vector>

namespace gloam::proxies {

/// Frobenius norm of the difference from the exact operator relative to the exact one's, each operator taking light (three
/// bands, before it is convolved with the cosine) to what a proxy sends.
struct OperatorDistance {
  float sine = 0.0f;  ///< of the proxy's half-angle
  double averaged = 0.0, point = 0.0;
};
/// At sines i / count, i = 1 … count.
std::vector<OperatorDistance> operatorDistances(int count);

/// ||a - exact||^2 / ||exact||^2 of the light that one white sphere sends to a plane.
struct PlaneErrors {
  double averaged = 0.0, point = 0.0;
};
/// The sphere has radius 1 and its centre at `height` (above 1) over the middle of a square of `width` a side, all metres;
/// side^2 receivers. `light` as proxyLight takes it.
PlaneErrors planeErrors(const sh::ShRgb& light, float height, float width, int side = 256);

/// Relative squared errors of D_1 and D_2, at 1,000 equal steps of the sine; below 0.02 the closed form is rounding.
struct FitErrors {
  double linear = 0.0, quadratic = 0.0;
};
FitErrors fitErrors();

}  // namespace gloam::proxies
