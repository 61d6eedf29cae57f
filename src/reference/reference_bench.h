// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How much of the tracing library's own speed the path tracer keeps.
#pragma once

#include <gloam/reference.h>

namespace gloam {

struct ReferenceBench {
  std::size_t triangles = 0;
  std::size_t points = 0;  ///< positions of the picture that meet a surface, in the tiles measured
  int samples = 0;         ///< a point and round
  std::size_t rays = 0;    ///< a round
  int rounds = 0;
  // Rates of one core, by processor time.
  double bare_mrays_s = 0.0;   ///< median: the same rays in the same order, one by one, and nothing else
  double paths_mrays_s = 0.0;  ///< median: the paths that made them, from random numbers to light
  double ratio = 0.0;          ///< median over rounds of paths / bare of one round
};

/// Records all rays of `samples` samples in tiles spread over the picture, then measures both in turn, tile by tile, on all
/// cores (options.threads), in `rounds` rounds: so a machine that changes its speed changes both. Throws as PathTracer does.
ReferenceBench benchReference(const Scene& scene, const PosedScene& posed, const PosedCamera& camera,
                              const Environment& environment, const ReferenceOptions& options,
                              int samples = 16, int rounds = 9);

}  // namespace gloam
