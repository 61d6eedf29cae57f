// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "image/measure_table.h"

#include <cmath>

namespace gloam {

std::span<const Measure> measureTable() {
  using enum Measure::Better;
  static constexpr Measure kMeasures[] = {
      {"rmse", "RMSE", "", "root of the mean squared difference", kLower, &Metrics::rmse},
      {"relative_rmse", "relative RMSE", "", "root of the relative squared error", kLower,
       &Metrics::relative_rmse},
      {"relative_squared_error", "relative squared error", "", "|a - b|^2 / |b|^2, as papers print it",
       kLower, &Metrics::relative_squared_error},
      {"psnr", "PSNR", "dB", "of the brightest value of the reference, or --peak", kHigher, &Metrics::psnr},
      {"ssim", "SSIM", "", "structural similarity of luminance; 1 is equal", kHigher, &Metrics::ssim},
      {"flip", "HDR-FLIP", "", "what is seen at some exposure; 0 to 1", kLower, &Metrics::flip},
      {"ldr_flip", "LDR-FLIP", "", "what is seen on a display; 0 to 1", kLower, &Metrics::ldr_flip},
      {"mean_signed_error", "mean signed error", "", "energy gained (+) or lost (-)", kNearerZero,
       &Metrics::mean_signed_error},
      {"relative_signed_error", "relative signed error", "", "the same, over the mean of the reference",
       kNearerZero, &Metrics::relative_signed_error},
      {"max_difference", "largest difference", "", "of any pixel and channel", kLower,
       &Metrics::max_difference},
  };
  return kMeasures;
}

double boundedValue(const Measure& measure, const Metrics& metrics) {
  const double value = metrics.*measure.value;
  return measure.better == Measure::Better::kNearerZero ? std::abs(value) : value;
}

bool exceeds(const Measure& measure, const Metrics& metrics, double bound) {
  const double value = boundedValue(measure, metrics);
  return measure.better == Measure::Better::kHigher ? value < bound : value > bound;
}

}  // namespace gloam
