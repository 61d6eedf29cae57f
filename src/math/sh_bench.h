// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Times the spherical-harmonics routines on one thread: `gloam bench sh` and the sh_bench program print these rows.
#pragma once

#include <gloam/error.h>

#include <string>
#include <vector>

namespace gloam::sh {

struct BenchRow {
  std::string name;  ///< "evaluate", "rotate", "rotate apply", "product"; with ", one" for single items
  int order = 0;
  double ns = 0.0;       ///< median processor time an item
  double ns_best = 0.0;  ///< of the fastest run
  double bar_ns = 0.0;   ///< what a public library reached on a two-core AMD EPYC with AVX-512; 0: no figure
  std::string bar_source;
};

/// Orders 3 to 6. Batches of 512 items that stay in cache; each row is the median of `runs` runs of at least
/// `seconds` each. Throws Interrupted where progress asks to stop.
std::vector<BenchRow> bench(int runs = 9, double seconds = 0.01, const Progress& progress = {});

/// The rows as a text table, with the instruction set that ran.
std::string benchTable(const std::vector<BenchRow>& rows);

}  // namespace gloam::sh
