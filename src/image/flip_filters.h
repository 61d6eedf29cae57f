// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The filters of FLIP for one distance of the eye.
#pragma once

#include "image/convolution.h"

namespace gloam {

/// Each is the row of a filter that is an outer product; all are in pixels.
struct FlipFilters {
  // Contrast sensitivity (2020, section 4.1.1, table 1): the product of the row with itself; the sum of two for the
  // blue-yellow channel. Each channel's filter has unit sum.
  Kernel<float> achromatic, red_green, blue_yellow_sharp, blue_yellow_soft;
  // Features (section 4.2): slope or curvature along one axis, a Gaussian along the other. What is positive sums to 1,
  // what is negative to -1.
  Kernel<float> gaussian, slope, curvature;
  int radius = 0;  ///< of the widest
};
FlipFilters flipFilters(double pixels_per_degree);

}  // namespace gloam
