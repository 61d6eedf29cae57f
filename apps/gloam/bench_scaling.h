// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam bench TECHNIQUE --scaling: how the time of a technique that takes spheres grows with their number.
#pragma once

#include "bench_stage.h"

namespace gloam::cli {

struct ScalingPoint {
  int count = 0;  ///< balls, a sphere and an object each
  Timings timings;
  double frame_ms = 0.0, light_ms = 0.0;
};
/// Medians over `frames` of each number, all numbers in turn.
std::vector<ScalingPoint> measureScaling(Renderer& renderer, const RenderOptions& options, int frames,
                                         Console& console);

/// 10 to 2,000 balls of one size strewn over one ground, a sphere each, seen by one camera. Prints times and what one more
/// sphere costs, writes a plot where -o asks for it.
int benchScaling(const BenchChoice& choice, Console& console);

}  // namespace gloam::cli
