// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Curves over one axis, as a picture or as numbers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gloam::cli {

struct PlotCurve {
  std::string name;
  std::vector<double> values;  ///< one a place
};

struct Plot {
  std::string title, across, up;  ///< what the axes are
  std::vector<double> places;
  std::vector<PlotCurve> curves;
  std::vector<std::string> notes;  ///< below the picture
};

/// As SVG, axes from 0 on.
std::string plotSvg(const Plot& plot);
/// One line a place, one column a curve.
std::string plotCsv(const Plot& plot);

/// What -o takes for a plot: throws Error unless it ends in .svg or .csv and can be written.
void checkPlotPath(const std::filesystem::path& path);
void writePlot(const Plot& plot, const std::filesystem::path& path);

}  // namespace gloam::cli
