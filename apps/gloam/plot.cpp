// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "plot.h"

#include <fmt/core.h>
#include <gloam/error.h>
#include <image/atomic_file.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace gloam::cli {
namespace {

constexpr double kWidth = 720.0, kHeight = 440.0, kLeft = 78.0, kRight = 24.0, kTop = 44.0, kBottom = 56.0;
constexpr double kNoteHeight = 17.0;
constexpr std::array<const char*, 6> kColors = {"#0b63a5", "#c2410c", "#15803d",
                                                "#7e22ce", "#0f766e", "#a16207"};

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

/// 1, 2 or 5 times a power of ten, so that about five steps reach the greatest value.
double niceStep(double greatest) {
  const double raw = std::max(greatest, 1e-12) / 5.0, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * 0.999) return factor * power;
  }
  return 10.0 * power;
}

struct Axis {
  double step, end;
  explicit Axis(double greatest) : step(niceStep(greatest)), end(step * std::ceil(greatest / step - 1e-9)) {
    if (!(end > 0.0)) end = step;
  }
};

std::string number(double value) {
  return fmt::format("{:.6g}", value);
}

}  // namespace

std::string plotSvg(const Plot& plot) {
  double across = 0.0, up = 0.0;
  for (const double x : plot.places) across = std::max(across, x);
  for (const PlotCurve& curve : plot.curves) {
    for (const double y : curve.values) up = std::isfinite(y) ? std::max(up, y) : up;
  }
  const Axis x_axis(across), y_axis(up);
  const auto px = [&](double x) { return kLeft + x / x_axis.end * (kWidth - kLeft - kRight); };
  const auto py = [&](double y) { return kHeight - kBottom - y / y_axis.end * (kHeight - kTop - kBottom); };
  const double height = kHeight + kNoteHeight * double(plot.notes.size());
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" font-size=\"13\" fill=\"#1f2937\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n<text x=\"{2}\" y=\"26\" "
      "font-size=\"16\">{3}</text>\n",
      kWidth, height, kLeft, escaped(plot.title));
  const double bottom = py(0.0), right = px(x_axis.end);
  for (int i = 0; double(i) * x_axis.step <= x_axis.end * 1.0001; ++i) {
    const double x = double(i) * x_axis.step;
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" stroke=\"#e5e7eb\"/>"
        "<text x=\"{0:.1f}\" y=\"{3:.1f}\" text-anchor=\"middle\">{4}</text>\n",
        px(x), bottom, py(y_axis.end), bottom + 18.0, number(x));
  }
  for (int i = 0; double(i) * y_axis.step <= y_axis.end * 1.0001; ++i) {
    const double y = double(i) * y_axis.step;
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}H{2:.1f}\" stroke=\"#e5e7eb\"/>"
        "<text x=\"{3:.1f}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
        kLeft, py(y), right, kLeft - 8.0, py(y) + 4.5, number(y));
  }
  svg += fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}H{3:.1f}\" fill=\"none\" stroke=\"#1f2937\"/>\n",
                     kLeft, py(y_axis.end), bottom, right);
  svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                     (kLeft + right) / 2, kHeight - 16.0, escaped(plot.across));
  svg +=
      fmt::format("<text transform=\"translate(18 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                  (kTop + bottom) / 2, escaped(plot.up));
  for (std::size_t c = 0; c < plot.curves.size(); ++c) {
    const PlotCurve& curve = plot.curves[c];
    std::string path;
    for (std::size_t i = 0; i < std::min(plot.places.size(), curve.values.size()); ++i) {
      if (std::isfinite(curve.values[i]))
        path +=
            fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", px(plot.places[i]), py(curve.values[i]));
    }
    const char* color = kColors[c % kColors.size()];
    const double y = kTop + 14.0 + 19.0 * double(c);
    svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", path, color);
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}h22\" stroke=\"{2}\" stroke-width=\"3\"/>"
        "<text x=\"{3:.1f}\" y=\"{4:.1f}\">{5}</text>\n",
        kLeft + 14.0, y - 4.0, color, kLeft + 44.0, y, escaped(curve.name));
  }
  for (std::size_t i = 0; i < plot.notes.size(); ++i) {
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"12\" fill=\"#6b7280\">{}</text>\n", kLeft,
                       kHeight + kNoteHeight * double(i), escaped(plot.notes[i]));
  }
  return svg + "</svg>\n";
}

std::string plotCsv(const Plot& plot) {
  const auto quoted = [](const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + '"';
  };
  std::string csv = quoted(plot.across);
  for (const PlotCurve& curve : plot.curves) csv += ',' + quoted(curve.name);
  csv += '\n';
  for (std::size_t i = 0; i < plot.places.size(); ++i) {
    csv += number(plot.places[i]);
    for (const PlotCurve& curve : plot.curves) csv += ',' + number(curve.values.at(i));
    csv += '\n';
  }
  return csv;
}

void checkPlotPath(const std::filesystem::path& path) {
  if (path.extension() != ".svg" && path.extension() != ".csv")
    throw Error(path.string(), "a plot is written as .svg or .csv");
  AtomicFile probe(path);
}

void writePlot(const Plot& plot, const std::filesystem::path& path) {
  const std::string text = path.extension() == ".csv" ? plotCsv(plot) : plotSvg(plot);
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

}  // namespace gloam::cli
