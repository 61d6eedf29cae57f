// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A sphere set for one solid.
#pragma once

#include <gloam/error.h>

#include "spheres/solid.h"

namespace gloam::spheres {

struct SearchOptions {
  int count = 26;
  std::uint32_t seed = 1;
  int samples =
      4000;  ///< points of the surface that lead the search, eight a ball at least; what they miss is found and added
  float effort = 1.0f;
  const Motion* motion = nullptr;  ///< of what deforms: balls then go with parts that stay together
};

/// At most `count` balls, in the solid's unit cube, that hold all of its surface. Same bits for any number of threads.
std::vector<Ball> findBalls(const Solid& solid, const SearchOptions& options, const Progress& progress);

/// What was reached; all volumes in the unit cube.
struct Measured {
  double volume = 0.0;         ///< of the solid
  double outside_sum = 0.0;    ///< sum of V(S_i \ O)
  double outside_union = 0.0;  ///< V((S_1 u S_2 u …) \ O)
  double coverage = 0.0;       ///< share of the surface inside at least one ball
};
/// By points of their own, not those of the search. Throws Interrupted when asked to stop.
Measured measureBalls(const Solid& solid, const std::vector<Ball>& balls, std::uint32_t seed,
                      const Progress& progress = {});

}  // namespace gloam::spheres
