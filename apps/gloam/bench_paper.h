// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam bench TECHNIQUE --paper: the figures of a technique's paper, ours beside theirs. A technique takes part by a function
// of this form and a line in bench_paper.cpp.
#pragma once

#include <optional>

#include "bench_stage.h"
#include "plot.h"

namespace gloam::cli {

struct PaperRow {
  enum class Better {
    kHigher,
    kLower,
    kNone
  };  ///< kNone: the paper's figure is for orientation, or there is none
  std::string name;
  double ours = 0.0;
  std::optional<double> paper;
  std::string unit;  ///< "ratio", "%", "frames/s" …
  Better better = Better::kNone;
  double within = 1.0;       ///< the paper's figure counts as reached up to this factor
  std::string command = {};  ///< of this row alone; empty: that of the whole table
};

struct PaperTable {
  std::string device;
  std::vector<PaperRow> rows;
  std::vector<std::string> notes;  ///< what a reader has to know; for people
  Plot plot;                       ///< written where -o asks for it
};

/// Null where no figures of this technique's paper are kept.
using MeasurePaper = PaperTable (*)(const BenchChoice& choice, Console& console);
MeasurePaper findPaper(const std::string& technique);
/// The techniques that have one.
std::vector<std::string> techniquesWithPaper();

/// Measures, prints, writes the plot.
int benchPaper(const BenchChoice& choice, Console& console);

PaperTable measureProxiesPaper(const BenchChoice& choice, Console& console);
PaperTable measureRadianceFilterPaper(const BenchChoice& choice, Console& console);
PaperTable measureSphericalLightsPaper(const BenchChoice& choice, Console& console);
PaperTable measureSplattingPaper(const BenchChoice& choice, Console& console);

}  // namespace gloam::cli
