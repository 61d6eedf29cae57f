// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How much of the tracing library's own speed a bake's first pass keeps.
#pragma once

#include <gloam/bake.h>

namespace gloam {

struct PrtBakeBench {
  std::size_t triangles = 0;
  std::size_t points = 0;  ///< points measured: whole blocks, spread over the scene
  std::size_t rays = 0;    ///< a round
  int rounds = 0;
  double bare_mrays_s =
      0.0;  ///< median: packets of the same rays handed to the tracing library and nothing else
  double bake_mrays_s = 0.0;  ///< median: the first pass with culling, occlusion bits and SH projection
  double ratio = 0.0;         ///< median over rounds of bake / bare of one round
  /// Median time of a bounce over that of the first pass of the same round: one that traces its rays, one that finds its
  /// hits kept. 0 without bounces.
  double first_bounce = 0.0, later_bounce = 0.0;
  int bounce_directions = 0;
};

/// Measures both in turn on all cores (options.threads), in `rounds` pairs of about a quarter of a second each half, so that
/// a machine that changes its speed changes both. Throws as bakeTransfer does.
PrtBakeBench benchBake(const Scene& scene, const BakeOptions& options, int rounds = 9);

}  // namespace gloam
