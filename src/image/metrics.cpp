// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// REF-2. Sums over pixels and colour channels, all from one pass in double precision; what looks at neighbours as well
// is in ssim.cpp and flip.cpp.
#include <gloam/metrics.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/comparison.h"
#include "image/flip.h"
#include "image/ssim.h"
#include "image/tonemap.h"

namespace gloam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Sums {
  double values = 0.0;  ///< how many: pixels times colour channels
  double signed_difference = 0.0, squared_difference = 0.0;
  double reference = 0.0, squared_reference = 0.0;
  double max_difference = 0.0, max_reference = 0.0;

  double meanSquare() const { return squared_difference / values; }
  double relativeSquare() const {
    return squared_difference == 0.0 ? 0.0 : squared_difference / squared_reference;
  }
  double relativeSigned() const {
    return signed_difference == 0.0 ? 0.0 : signed_difference / std::abs(reference);
  }
  double peak(double asked) const {
    if (asked > 0.0) return asked;
    return max_reference > 0.0 ? max_reference : 1.0;
  }
  double psnr(double asked_peak) const {
    if (squared_difference == 0.0) return kInfinity;
    const double white = peak(asked_peak);
    return 10.0 * std::log10(white * white / meanSquare());
  }
};

Sums sumsOf(const Image& a, const Image& reference, const Image& mask) {
  requireComparable(a, reference);
  requireMask(mask, reference);
  const std::size_t colors = std::size_t(colorChannels(a)), channels = std::size_t(a.channels);
  Sums sums;
  for (std::size_t pixel = 0; pixel < a.pixelCount(); ++pixel) {
    if (!takes(mask, pixel)) continue;
    for (std::size_t i = pixel * channels; i < pixel * channels + colors; ++i) {
      const double expected = double(reference.pixels[i]), difference = double(a.pixels[i]) - expected;
      sums.signed_difference += difference;
      sums.squared_difference += difference * difference;
      sums.reference += expected;
      sums.squared_reference += expected * expected;
      sums.max_difference = std::max(sums.max_difference, std::abs(difference));
      sums.max_reference = std::max(sums.max_reference, expected);
    }
    sums.values += double(colors);
  }
  return sums;
}

}  // namespace

Metrics measure(const Image& a, const Image& reference, const MetricOptions& options,
                const Progress& progress) {
  requirePixelsPerDegree(options.pixels_per_degree);
  const Sums sums = sumsOf(a, reference, options.mask);
  Metrics metrics;
  metrics.pixels = std::size_t(sums.values) / std::size_t(colorChannels(a));
  metrics.max_difference = sums.max_difference;
  metrics.rmse = std::sqrt(sums.meanSquare());
  metrics.relative_squared_error = sums.relativeSquare();
  metrics.relative_rmse = std::sqrt(metrics.relative_squared_error);
  metrics.psnr = sums.psnr(options.peak);
  metrics.mean_signed_error = sums.signed_difference / sums.values;
  metrics.relative_signed_error = sums.relativeSigned();
  metrics.ssim =
      meanOf(ssimMap(a, reference, sums.peak(options.peak), {progress, 0.0, 0.05, "SSIM"}), options.mask);
  metrics.flip = meanOf(hdrFlip(a, reference, options.pixels_per_degree, {progress, 0.05, 0.85, "HDR-FLIP"}),
                        options.mask);
  const DisplayOptions display = displayFor(reference, options.display);
  metrics.ldr_flip = meanOf(ldrFlip(toneMapped(a, display), toneMapped(reference, display),
                                    options.pixels_per_degree, {progress, 0.85, 1.0, "LDR-FLIP"}),
                            options.mask);
  return metrics;
}

double maxDifference(const Image& a, const Image& reference) {
  return sumsOf(a, reference, {}).max_difference;
}

double rmse(const Image& a, const Image& reference) {
  return std::sqrt(sumsOf(a, reference, {}).meanSquare());
}

double relativeSquaredError(const Image& a, const Image& reference) {
  return sumsOf(a, reference, {}).relativeSquare();
}

double psnr(const Image& a, const Image& reference, double peak) {
  return sumsOf(a, reference, {}).psnr(peak);
}

double meanSignedError(const Image& a, const Image& reference) {
  const Sums sums = sumsOf(a, reference, {});
  return sums.signed_difference / sums.values;
}

}  // namespace gloam
