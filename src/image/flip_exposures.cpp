// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Andersson et al. 2021, section 3: with x_max where the tone curve reaches 0.85, exposures run from
// c_start = log2(x_max / Y_max) to c_stop = log2(x_max / Y_median) of the reference's luminance, in
// max(2, ceil(c_stop - c_start)) even steps.
// Ours, where that rule has no answer: the median of the lit pixels where half of the reference is black; exposure 0
// where all of it is; at most 64 exposures.
#include <algorithm>
#include <cmath>

#include "image/flip.h"
#include "image/tonemap.h"

namespace gloam {
namespace {

constexpr double kBrightest = 0.85;
constexpr int kMostExposures = 64;

std::vector<float> luminances(const Image& image) {
  std::vector<float> values;
  values.reserve(image.pixelCount());
  for (std::size_t i = 0; i < image.pixelCount(); ++i) {
    const float* p = &image.pixels[i * std::size_t(image.channels)];
    values.push_back(image.channels >= 3 ? luminance({p[0], p[1], p[2]}) : p[0]);
  }
  return values;
}

/// The middle one, or the mean of both; the order is lost.
double median(std::vector<float>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const double upper = double(*middle);
  return values.size() % 2 == 1 ? upper : 0.5 * (upper + double(*std::max_element(values.begin(), middle)));
}

/// Radiance that the tone curve takes to kBrightest: the positive root of a quadratic.
double brightestExposed() {
  const double a = 0.36 * (2.51 - kBrightest * 2.43), b = 0.6 * (0.03 - kBrightest * 0.59),
               c = -kBrightest * 0.14;
  return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
}

}  // namespace

FlipExposures flipExposures(const Image& reference) {
  std::vector<float> values = luminances(reference);
  const double brightest = double(*std::ranges::max_element(values));
  if (!(brightest > 0.0)) return {};
  double middle = median(values);
  if (!(middle > 0.0)) {
    std::erase_if(values, [](float value) { return !(value > 0.0f); });
    middle = median(values);
  }
  const double exposed = brightestExposed();
  FlipExposures exposures;
  exposures.start = std::log2(exposed / brightest);
  exposures.stop = std::log2(exposed / middle);
  exposures.count = std::clamp(int(std::ceil(exposures.stop - exposures.start)), 2, kMostExposures);
  return exposures;
}

}  // namespace gloam
