// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-8: how far each exponential is from exp(M_f) 1, and all of them from what is truly visible, over sets of spheres.
#pragma once

#include <gloam/error.h>

#include <string>
#include <vector>

#include "math/sh_blockers.h"

namespace gloam::sh {

/// Errors are root mean squares over the sphere and over the sets, where 1 is visible and 0 is not.
struct ExpErrorRow {
  int order = 0;
  Arrangement arrangement = Arrangement::kScattered;
  int blockers = 0;
  double norm = 0.0;                                       ///< mean length of f^
  double hybrid_products = 0.0, quadratic_products = 0.0;  ///< mean number of products
  /// Against exp(M_f) 1: PS of 4 and 9 terms, OL, HYB, quadratic.
  double series4 = 0.0, series9 = 0.0, linear = 0.0, hybrid = 0.0, quadratic = 0.0;
  /// Against the projected visibility: exp(M_f) 1; exp of the function's values, projected; the blockers' product; OL;
  /// HYB; quadratic.
  double visible_numeric = 0.0, visible_pointwise = 0.0, visible_product = 0.0, visible_linear = 0.0,
         visible_hybrid = 0.0, visible_quadratic = 0.0;
};

/// Of these numbers of blockers in both arrangements, `sets` sets each. Throws Interrupted where progress asks to stop.
std::vector<ExpErrorRow> expErrors(int order, const std::vector<int>& blockers, int sets,
                                   const Progress& progress = {});
/// Orders 3 to 6; 1, 4, 16 and 40 blockers, 24 sets each: the table of docs/sh.md.
std::vector<ExpErrorRow> expErrors(const Progress& progress = {});
const char* arrangementName(Arrangement arrangement);  ///< "scattered", "body"
/// As text, errors in percent.
std::string expErrorTable(const std::vector<ExpErrorRow>& rows);

}  // namespace gloam::sh
