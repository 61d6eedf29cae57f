// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How well matrices of shadowed gloss (GS, PRT-2) hold against plain integrals, with the lobe's truncation told apart.
#pragma once

#include <gloam/bake.h>
#include <gloam/sh.h>

#include <vector>

namespace gloam {

/// Of one exponent: relative root mean squares over points, mirror directions and colours.
struct PrtGlossRow {
  float exponent = 0.0f,
        shown = 0.0f;  ///< the material's; the sharpest that so many bands show, if that is less
  /// Against the integral of visibility x light x the same lobe in the same bands.
  double matrix = 0.0, cheap = 0.0, unshadowed = 0.0;
  /// That integral against the one with the whole lobe of the material's exponent: what no matrix of so many bands can hold.
  double truncation = 0.0;
};
struct PrtGlossBench {
  int order = 0, directions = 0;  ///< of the matrices
  std::size_t points = 0;         ///< measured, spread over the scene
  int truth_directions = 0;       ///< of the integrals, a point
  std::vector<PrtGlossRow> rows;
};

/// Bakes GS of up to some hundred points of all rigid meshes and integrates at each, along other and more directions, what it
/// reflects of the light (of options.order bands, in the world's axes) towards some mirror directions above it. Exponents 3, 10, 30 and
/// 100. Throws as bakeTransfer does.
PrtGlossBench benchGloss(const Scene& scene, const sh::ShRgb& light, BakeOptions options);

}  // namespace gloam
