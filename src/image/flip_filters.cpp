// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Andersson et al. 2020. Contrast sensitivity as Gaussians, section 4.1.1:
//   g(x) = a1 sqrt(pi/b1) exp(-pi^2 x^2 / b1) + a2 sqrt(pi/b2) exp(-pi^2 x^2 / b2), x in degrees, table 1;
// cut at 3 standard deviations of the widest. Features, section 4.2: a Gaussian of sigma w/2 with w = 0.082 degrees,
// cut at 3 sigma, its first derivative for edges and its second for points.
// Ours: each Gaussian is applied along rows and columns one after the other, which is the same filter; weights below a
// billionth of the greatest are left out.
#include "image/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gloam {
namespace {

constexpr double kPi = std::numbers::pi;

struct Gaussian {
  double a, b;
};
constexpr Gaussian kAchromatic{1.0, 0.0047}, kRedGreen{1.0, 0.0053}, kBlueYellowSharp{34.1, 0.04},
    kBlueYellowSoft{13.5, 0.025};
constexpr double kFeatureWidthDegrees = 0.082;

using Weights = std::vector<double>;  ///< at 0, 1, 2 … pixels from the middle

double sum(const Weights& weights) {
  double total = weights[0];
  for (std::size_t k = 1; k < weights.size(); ++k) total += 2.0 * weights[k];
  return total;
}

Weights row(const Gaussian& gaussian, int radius, double pixels_per_degree) {
  Weights weights;
  for (int k = 0; k <= radius; ++k) {
    const double degrees = k / pixels_per_degree;
    weights.push_back(std::exp(-kPi * kPi * degrees * degrees / gaussian.b));
  }
  return weights;
}

/// In single precision, scaled, without the tail that rounding swallows.
Kernel<float> kernelOf(const Weights& weights, double scale) {
  double greatest = 0.0;
  for (const double weight : weights) greatest = std::max(greatest, std::abs(weight));
  std::size_t size = weights.size();
  while (size > 1 && std::abs(weights[size - 1]) < 1e-9 * greatest) --size;
  Kernel<float> kernel;
  for (std::size_t k = 0; k < size; ++k) kernel.half.push_back(float(weights[k] * scale));
  return kernel;
}

void addContrastSensitivity(FlipFilters& filters, double pixels_per_degree) {
  const double widest = std::sqrt(kBlueYellowSharp.b / (2.0 * kPi * kPi));
  const int radius = int(std::ceil(3.0 * widest * pixels_per_degree));
  const auto single = [&](const Gaussian& gaussian) {
    const Weights weights = row(gaussian, radius, pixels_per_degree);
    return kernelOf(weights, 1.0 / sum(weights));
  };
  filters.achromatic = single(kAchromatic);
  filters.red_green = single(kRedGreen);

  const Weights sharp = row(kBlueYellowSharp, radius, pixels_per_degree);
  const Weights soft = row(kBlueYellowSoft, radius, pixels_per_degree);
  const auto factor = [](const Gaussian& gaussian) { return gaussian.a * std::sqrt(kPi / gaussian.b); };
  const double sharp_factor = factor(kBlueYellowSharp), soft_factor = factor(kBlueYellowSoft);
  const double total = sharp_factor * sum(sharp) * sum(sharp) + soft_factor * sum(soft) * sum(soft);
  filters.blue_yellow_sharp = kernelOf(sharp, std::sqrt(sharp_factor / total));
  filters.blue_yellow_soft = kernelOf(soft, std::sqrt(soft_factor / total));
}

void addFeatures(FlipFilters& filters, double pixels_per_degree) {
  const double sigma = 0.5 * kFeatureWidthDegrees * pixels_per_degree;
  Weights gaussian, slope, curvature;
  double slope_sum = 0.0, positive = 0.0, negative = 0.0;
  for (int k = 0; k <= int(std::ceil(3.0 * sigma)); ++k) {
    const double x = k / sigma, g = std::exp(-0.5 * x * x), sides = k == 0 ? 1.0 : 2.0;
    gaussian.push_back(g);
    slope.push_back(x * g);
    curvature.push_back((x * x - 1.0) * g);
    slope_sum += slope.back();
    (curvature.back() > 0.0 ? positive : negative) += sides * std::abs(curvature.back());
  }
  for (double& weight : curvature) weight /= weight > 0.0 ? positive : negative;
  filters.gaussian = kernelOf(gaussian, 1.0 / sum(gaussian));
  filters.slope = kernelOf(slope, 1.0 / slope_sum);
  filters.curvature = kernelOf(curvature, 1.0);
}

}  // namespace

FlipFilters flipFilters(double pixels_per_degree) {
  FlipFilters filters;
  addContrastSensitivity(filters, pixels_per_degree);
  addFeatures(filters, pixels_per_degree);
  for (const Kernel<float>* kernel :
       {&filters.achromatic, &filters.red_green, &filters.blue_yellow_sharp, &filters.blue_yellow_soft,
        &filters.gaussian, &filters.slope, &filters.curvature})
    filters.radius = std::max(filters.radius, kernel->radius());
  return filters;
}

}  // namespace gloam
