// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Finds the coefficients of sh_exp_tables.h; the tests and the program sh_fit_exp use it, the library does not.
#pragma once

#include <string>
#include <vector>

#include "math/sh_exp_core.h"

namespace gloam::sh {

/// a and b of expLinear at |f^| = 0, step, 2 step …
struct ExpLinearTable {
  std::vector<double> a, b;
};
ExpLinearTable fitExpLinear(int order, int entries, double step);
/// HYB's core, or the quadratic one, for that range.
ExpCore fitExpCore(int order, bool quadratic, float range);
/// The whole of sh_exp_tables.h.
std::string expTablesText();

}  // namespace gloam::sh
