// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// REF-2: all five measures come from one pass of sums in double precision.
#include <gloam/metrics.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gloam {
namespace {

struct Sums {
  double values = 0.0;  ///< how many
  double signed_difference = 0.0, squared_difference = 0.0, squared_reference = 0.0;
  double max_difference = 0.0, max_reference = 0.0;
};

Sums sumsOf(const Image& a, const Image& reference) {
  if (a.width != reference.width || a.height != reference.height || a.channels != reference.channels)
    throw Error(
        fmt::format("pictures of one size were expected, not {} x {} with {} channels and {} x {} with {}",
                    a.width, a.height, a.channels, reference.width, reference.height, reference.channels));
  if (a.empty()) throw Error("pictures without pixels cannot be compared");
  const int colors = a.channels >= 3 ? 3 : 1;
  Sums sums;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (int(i % std::size_t(a.channels)) >= colors) continue;
    const double value = a.pixels[i], expected = reference.pixels[i], difference = value - expected;
    if (!std::isfinite(difference)) {
      const std::size_t pixel = i / std::size_t(a.channels), width = std::size_t(a.width);
      throw Error(fmt::format("pixel ({}, {}) is not finite in the {}", pixel % width, pixel / width,
                              std::isfinite(value) ? "reference" : "picture"));
    }
    sums.values += 1.0;
    sums.signed_difference += difference;
    sums.squared_difference += difference * difference;
    sums.squared_reference += expected * expected;
    sums.max_difference = std::max(sums.max_difference, std::abs(difference));
    sums.max_reference = std::max(sums.max_reference, expected);
  }
  return sums;
}

}  // namespace

double maxDifference(const Image& a, const Image& reference) {
  return sumsOf(a, reference).max_difference;
}

double rmse(const Image& a, const Image& reference) {
  const Sums sums = sumsOf(a, reference);
  return std::sqrt(sums.squared_difference / sums.values);
}

double relativeSquaredError(const Image& a, const Image& reference) {
  const Sums sums = sumsOf(a, reference);
  return sums.squared_difference == 0.0 ? 0.0 : sums.squared_difference / sums.squared_reference;
}

double psnr(const Image& a, const Image& reference, double peak) {
  const Sums sums = sumsOf(a, reference);
  if (sums.squared_difference == 0.0) return std::numeric_limits<double>::infinity();
  const double top = peak > 0.0 ? peak : sums.max_reference;
  return 10.0 * std::log10(top * top * sums.values / sums.squared_difference);
}

double meanSignedError(const Image& a, const Image& reference) {
  const Sums sums = sumsOf(a, reference);
  return sums.signed_difference / sums.values;
}

}  // namespace gloam
