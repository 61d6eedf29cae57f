// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-2: projection of functions and of analytic lights.
//   disc: integral of P_l over (cos a, 1) = sin^2 a P_l'(cos a) / (l (l + 1)), which loses no digits in small discs.
#include <array>
#include <cmath>

#include "math/quadrature.h"
#include "math/sh_check.h"
#include "math/sh_exact.h"

namespace gloam::sh {
namespace {

/// T is float or vec3, Wide its double twin, in which the sums are kept.
template <class T, class Wide, class Function>
Coefficients<T> projectWith(int order, const Function& function, int rings) {
  checkOrder(order);
  if (rings < 1 || rings > 4096)
    throw Error("spherical harmonics",
                "quadrature of " + std::to_string(rings) + " rings, expected 1 to 4096");
  const GaussLegendre<double> rule(rings);
  const int columns = 2 * rings;
  const double step = 2.0 * exact::kPi / columns;
  std::array<Wide, kMaxCoefficients> sum{};
  for (int ring = 0; ring < rings; ++ring) {
    const double z = rule.nodes[static_cast<std::size_t>(ring)], radius = std::sqrt(1.0 - z * z);
    for (int column = 0; column < columns; ++column) {
      const double phi = (column + 0.5) * step;
      const glm::vec3 direction(radius * std::cos(phi), radius * std::sin(phi), z);
      const Wide weighted = Wide(function(direction)) * (rule.weights[static_cast<std::size_t>(ring)] * step);
      const Sh basis = evaluate(order, direction);
      for (int i = 0; i < basis.size(); ++i) sum[static_cast<std::size_t>(i)] += weighted * double(basis[i]);
    }
  }
  Coefficients<T> result(order);
  for (int i = 0; i < result.size(); ++i) result[i] = T(sum[static_cast<std::size_t>(i)]);
  return result;
}

/// Zonal coefficients of max(0, t), t the cosine from the axis.
Zh ramp(int order) {
  Zh zonal{order, {}};
  for (int l = 0; l < order; ++l) {
    const exact::Polynomial legendre = exact::legendreDerivative(l, 0);
    double integral = 0.0;
    for (int i = 0; i <= l; ++i) integral += legendre.c[static_cast<std::size_t>(i)] / (i + 2);
    zonal[l] = static_cast<float>(2.0 * exact::kPi * exact::normalization(l, 0) * integral);
  }
  return zonal;
}

}  // namespace

Sh project(int order, const std::function<float(const glm::vec3&)>& function, int rings) {
  return projectWith<float, double>(order, function, rings);
}

ShRgb projectRgb(int order, const std::function<glm::vec3(const glm::vec3&)>& function, int rings) {
  return projectWith<glm::vec3, glm::dvec3>(order, function, rings);
}

Sh directionalLight(int order, const glm::vec3& direction) {
  return evaluate(order, direction);
}

Zh discZonal(int order, float half_angle_rad) {
  checkOrder(order);
  if (!(half_angle_rad >= 0.0f && half_angle_rad <= 3.1415928f))
    throw Error("spherical harmonics",
                "disc of half-angle " + std::to_string(half_angle_rad) + ", expected 0 to pi");
  const double angle = half_angle_rad, sine = std::sin(angle), half_sine = std::sin(0.5 * angle);
  Zh zonal{order, {}};
  for (int l = 0; l < order; ++l) {
    const double integral =
        l == 0
            ? 2.0 * half_sine * half_sine
            : sine * sine * exact::valueOf(exact::legendreDerivative(l, 1), std::cos(angle)) / (l * (l + 1));
    zonal[l] = static_cast<float>(2.0 * exact::kPi * exact::normalization(l, 0) * integral);
  }
  return zonal;
}

Sh disc(int order, const glm::vec3& axis, float half_angle_rad) {
  return rotateZonal(discZonal(order, half_angle_rad), axis);
}

ShRgb constantSky(int order, const glm::vec3& radiance) {
  checkOrder(order);
  ShRgb sky(order);
  sky[0] = radiance * zonalFactor(0);  // sqrt(4 pi), the integral of y_00
  return sky;
}

ShRgb gradientSky(int order, const glm::vec3& zenith, const glm::vec3& horizon, const glm::vec3& nadir) {
  // horizon + max(0, t) (zenith - horizon) + max(0, -t) (nadir - horizon), t the sine of the elevation.
  const glm::vec3 up(0.0f, 1.0f, 0.0f);
  ShRgb sky = constantSky(order, horizon);
  const Zh half = ramp(order);
  sky += colored(rotateZonal(half, up), zenith - horizon);
  sky += colored(rotateZonal(half, -up), nadir - horizon);
  return sky;
}

}  // namespace gloam::sh
