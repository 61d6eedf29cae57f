// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-9: windows against ringing (Sloan 2008). The least one that keeps a function non-negative takes the factors of
// Sloan's windowing by the squared Laplacian, 1 / (1 + lambda l^2 (l + 1)^2), and finds lambda by bisection on the
// function's minimum over the sphere.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "math/sampling.h"
#include "math/sh_basis.h"
#include "math/sh_check.h"
#include "math/sh_constants.h"
#include "math/sh_exact.h"

namespace gloam::sh {
namespace {

using Factors = std::array<float, kMaxOrder>;
using Values = std::array<double, kMaxCoefficients>;

template <class T>
Coefficients<T> windowed(const Coefficients<T>& function, const Factors& factors) {
  Coefficients<T> result = function;
  for (int l = 0; l < function.order; ++l)
    for (int m = -l; m <= l; ++m) result[index(l, m)] *= factors[static_cast<std::size_t>(l)];
  return result;
}

Factors hannFactors(float width) {
  if (!(width > 0.0f)) throw Error("window", "width " + std::to_string(width) + ", expected more than 0");
  Factors factors{};
  for (int l = 0; l < kMaxOrder && static_cast<float>(l) < width; ++l)
    factors[static_cast<std::size_t>(l)] = static_cast<float>(0.5 + 0.5 * std::cos(exact::kPi * l / width));
  return factors;
}

Factors lanczosFactors(float width) {
  if (!(width > 0.0f)) throw Error("window", "width " + std::to_string(width) + ", expected more than 0");
  Factors factors{1.0f};
  for (int l = 1; l < kMaxOrder && static_cast<float>(l) < width; ++l) {
    const double x = exact::kPi * l / width;
    factors[static_cast<std::size_t>(l)] = static_cast<float>(std::sin(x) / x);
  }
  return factors;
}

Factors laplacianFactors(double lambda) {
  Factors factors{};
  for (int l = 0; l < kMaxOrder; ++l)
    factors[static_cast<std::size_t>(l)] =
        static_cast<float>(1.0 / (1.0 + lambda * l * l * (l + 1) * (l + 1)));
  return factors;
}

double preciseValueAt(const Sh& function, const glm::dvec3& direction) {
  Values basis{};
  const double x = direction.x, y = direction.y, z = direction.z;
  GLOAM_SH_BASIS_6(basis, x, y, z)
  double sum = 0.0;
  for (int i = 0; i < function.size(); ++i) sum += double(function[i]) * basis[static_cast<std::size_t>(i)];
  return sum;
}

/// Walks down from a direction: Newton steps on the tangent plane by finite differences, halved until they descend.
double descend(const Sh& function, glm::dvec3& direction) {
  double value = preciseValueAt(function, direction);
  for (int step = 0; step < 20; ++step) {
    const glm::dvec3 helper = std::abs(direction.z) < 0.7 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(helper, direction)), v = glm::cross(direction, u);
    const auto moved = [&](double a, double b) { return glm::normalize(direction + a * u + b * v); };
    const auto at = [&](double a, double b) { return preciseValueAt(function, moved(a, b)); };
    const double h = 1e-4;
    const double px = at(h, 0), mx = at(-h, 0), py = at(0, h), my = at(0, -h), pp = at(h, h);
    const double gx = (px - mx) / (2 * h), gy = (py - my) / (2 * h);
    const double xx = (px + mx - 2 * value) / (h * h), yy = (py + my - 2 * value) / (h * h);
    const double xy = (pp - px - py + value) / (h * h);
    const double determinant = xx * yy - xy * xy;
    double a = -gx, b = -gy;
    if (determinant > 0 && xx > 0) {
      a = (-gx * yy + gy * xy) / determinant;
      b = (-gy * xx + gx * xy) / determinant;
    }
    const double length = std::sqrt(a * a + b * b);
    if (length < 1e-9) break;
    double scale = std::min(1.0, 0.2 / length);
    while (scale > 1e-6 && at(scale * a, scale * b) >= value) scale *= 0.5;
    if (scale <= 1e-6) break;
    direction = moved(scale * a, scale * b);
    value = preciseValueAt(function, direction);
  }
  return value;
}

/// Least lambda at which no channel with a positive mean falls below 0.
double leastLambda(const std::array<Sh, 3>& channels, int count) {
  const auto holds = [&](double lambda) {
    const Factors factors = laplacianFactors(lambda);
    for (int i = 0; i < count; ++i) {
      const Sh& channel = channels[static_cast<std::size_t>(i)];
      if (channel[0] > 0.0f && minimum(windowed(channel, factors)).value < 0.0f) return false;
    }
    return true;
  };
  if (holds(0.0)) return 0.0;
  double high = 1e-3;
  while (!holds(high)) high *= 4.0;  // ends: with large lambda only the positive mean is left
  double low = 0.0;
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

Minimum minimum(const Sh& function) {
  checkOrder(function.order);
  constexpr int kStarts = 600;  // 8 degrees apart: several within each dip of order 6
  static const std::vector<glm::vec3> directions = sampling::fibonacciSphere(kStarts);
  std::array<std::pair<double, int>, kStarts> starts;
  for (int i = 0; i < kStarts; ++i)
    starts[static_cast<std::size_t>(i)] = {valueAt(function, directions[static_cast<std::size_t>(i)]), i};
  constexpr int kDescents = 8;
  std::partial_sort(starts.begin(), starts.begin() + kDescents, starts.end());
  Minimum least{std::numeric_limits<float>::infinity(), {}};
  for (int i = 0; i < kDescents; ++i) {
    glm::dvec3 direction(directions[static_cast<std::size_t>(starts[static_cast<std::size_t>(i)].second)]);
    const auto value = static_cast<float>(descend(function, direction));
    if (value < least.value) least = {value, glm::vec3(direction)};
  }
  return least;
}

Sh windowHann(const Sh& function, float width) {
  return windowed(function, hannFactors(width));
}
ShRgb windowHann(const ShRgb& function, float width) {
  return windowed(function, hannFactors(width));
}
Sh windowLanczos(const Sh& function, float width) {
  return windowed(function, lanczosFactors(width));
}
ShRgb windowLanczos(const ShRgb& function, float width) {
  return windowed(function, lanczosFactors(width));
}

Sh windowNonNegative(const Sh& function) {
  const double lambda = leastLambda({function, Sh(), Sh()}, 1);
  return windowed(function, laplacianFactors(lambda));
}

ShRgb windowNonNegative(const ShRgb& function) {
  std::array<Sh, 3> channels;
  for (int channel = 0; channel < 3; ++channel) {
    Sh& single = channels[static_cast<std::size_t>(channel)];
    single.order = function.order;
    for (int i = 0; i < function.size(); ++i) single[i] = function[i][channel];
  }
  return windowed(function, laplacianFactors(leastLambda(channels, 3)));
}

}  // namespace gloam::sh
