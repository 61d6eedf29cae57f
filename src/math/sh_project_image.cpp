// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-2: projection of pictures.
//
// Equirectangular: with y and z exchanged the picture's pole is that of the basis, and y_lm = N p(z) sin^|m| Phi_m(phi)
// integrates over a texel as a product: sin and cos integrals along a row, Gauss points across it. The exchange matrix J
// turns the result back. Exact for texels of constant radiance; 11 sums a texel instead of 36.
// Cube: Gauss points in each texel (2 x 2, more in small cubes), weighted so that they sum to its exact solid angle.
#include <algorithm>
#include <array>
#include <cmath>

#include "math/quadrature.h"
#include "math/sh_check.h"
#include "math/sh_tables.h"

namespace gloam::sh {
namespace {

constexpr int kHarmonics = 2 * kMaxOrder - 1;  // Phi_m, m = -5 … 5
using Harmonics = std::array<glm::dvec3, kHarmonics>;

/// Integrals of Phi_m along each texel of a row: [column * kHarmonics + m + 5].
std::vector<double> azimuthIntegrals(int width) {
  std::vector<double> table(static_cast<std::size_t>(width) * kHarmonics);
  const double step = 2.0 * exact::kPi / width;
  for (int column = 0; column < width; ++column) {
    double* entry = table.data() + static_cast<std::size_t>(column) * kHarmonics + (kMaxOrder - 1);
    const double middle = (column + 0.5) * step - exact::kPi;
    entry[0] = step;
    for (int m = 1; m < kMaxOrder; ++m) {
      // Over a texel, cos m phi integrates to its middle value times sin(m step / 2) / (m / 2).
      const double length = std::sqrt(2.0) * std::sin(0.5 * m * step) / (0.5 * m);
      entry[m] = length * std::cos(m * middle);
      entry[-m] = length * std::sin(m * middle);
    }
  }
  return table;
}

/// N p(z) sin^|m| of all (l, |m|), at index(l, |m|).
struct PolarBasis {
  std::array<exact::Polynomial, kMaxCoefficients> polynomial;
  std::array<double, kMaxCoefficients> norm{};
  PolarBasis() {
    for (int l = 0; l < kMaxOrder; ++l)
      for (int m = 0; m <= l; ++m) {
        const auto i = static_cast<std::size_t>(index(l, m));
        polynomial[i] = exact::legendreDerivative(l, m);
        norm[i] = exact::normalization(l, m);
      }
  }
  double at(int l, int m, double z, double radius) const {
    const auto i = static_cast<std::size_t>(index(l, m));
    double value = norm[i] * exact::valueOf(polynomial[i], z);
    for (int k = 0; k < m; ++k) value *= radius;
    return value;
  }
};

struct RowEdges {
  double top, bottom;  ///< sines of the elevation
};
RowEdges rowEdges(int row, int height) {
  const double step = exact::kPi / height;
  return {std::cos(row * step), std::cos((row + 1) * step)};
}

/// `rows` rows of `columns` texels, columns below 2^34.
void checkTexels(const char* what, std::size_t given, long long columns, long long rows) {
  const auto texels = static_cast<long long>(given);
  if (columns < 1 || rows < 1 || texels % rows != 0 || texels / rows != columns)
    throw Error(what, std::to_string(given) + " texels, expected " + std::to_string(columns) + " x " +
                          std::to_string(rows) + " of them, at least one");
}

/// Integral of 1 / (1 + s^2 + t^2)^(3/2) over [0, s] x [0, t].
double cornerSolidAngle(double s, double t) {
  return std::atan2(s * t, std::sqrt(s * s + t * t + 1.0));
}

double texelSolidAngle(int column, int row, int size) {
  const double s0 = 2.0 * column / size - 1.0, s1 = 2.0 * (column + 1) / size - 1.0;
  const double t0 = 2.0 * row / size - 1.0, t1 = 2.0 * (row + 1) / size - 1.0;
  return cornerSolidAngle(s0, t0) - cornerSolidAngle(s0, t1) - cornerSolidAngle(s1, t0) +
         cornerSolidAngle(s1, t1);
}

using Values = std::array<double, kMaxCoefficients>;

/// Integral of the basis over a texel of a cube.
Values texelIntegral(int order, int face, int column, int row, int size, const GaussLegendre<double>& rule) {
  Values basis{};
  double weight_sum = 0.0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i)
    for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
      const double u = (column + 0.5 + 0.5 * rule.nodes[i]) / size,
                   v = (row + 0.5 + 0.5 * rule.nodes[j]) / size;
      const double s = 2.0 * u - 1.0, t = 2.0 * v - 1.0, distance2 = 1.0 + s * s + t * t;
      const double weight = rule.weights[i] * rule.weights[j] / (distance2 * std::sqrt(distance2));
      const Sh y = evaluate(order, cubeDirection(face, static_cast<float>(u), static_cast<float>(v)));
      for (int k = 0; k < y.size(); ++k) basis[static_cast<std::size_t>(k)] += weight * double(y[k]);
      weight_sum += weight;
    }
  for (double& value : basis) value *= texelSolidAngle(column, row, size) / weight_sum;
  return basis;
}

}  // namespace

ShRgb projectEquirectangular(int order, std::span<const glm::vec3> texels, int width, int height) {
  checkOrder(order);
  checkTexels("equirectangular projection", texels.size(), width, height);
  const std::vector<double> azimuth = azimuthIntegrals(width);
  const PolarBasis polar;
  const GaussLegendre<double> rule(8);
  std::array<glm::dvec3, kMaxCoefficients> sum{};
  for (int row = 0; row < height; ++row) {
    Harmonics harmonics{};
    const glm::vec3* texel = texels.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
    for (int column = 0; column < width; ++column) {
      const double* integral = azimuth.data() + static_cast<std::size_t>(column) * kHarmonics;
      const glm::dvec3 radiance(texel[column]);
      for (std::size_t m = 0; m < kHarmonics; ++m) harmonics[m] += radiance * integral[m];
    }
    const RowEdges edges = rowEdges(row, height);
    const double middle = 0.5 * (edges.top + edges.bottom), half = 0.5 * (edges.top - edges.bottom);
    for (int l = 0; l < order; ++l)
      for (int m = 0; m <= l; ++m) {
        double across = 0.0;
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
          const double z = middle + half * rule.nodes[i];
          across += half * rule.weights[i] * polar.at(l, m, z, std::sqrt(std::max(0.0, 1.0 - z * z)));
        }
        sum[static_cast<std::size_t>(index(l, m))] +=
            across * harmonics[static_cast<std::size_t>(kMaxOrder - 1 + m)];
        if (m > 0)
          sum[static_cast<std::size_t>(index(l, -m))] +=
              across * harmonics[static_cast<std::size_t>(kMaxOrder - 1 - m)];
      }
  }
  ShRgb result(order);
  for (int l = 0; l < order; ++l)
    for (int r = 0; r <= 2 * l; ++r) {
      glm::dvec3 turned(0.0);
      for (int c = 0; c <= 2 * l; ++c)
        turned += double(tables::kExchange[static_cast<std::size_t>(l)][static_cast<std::size_t>(r)]
                                          [static_cast<std::size_t>(c)]) *
                  sum[static_cast<std::size_t>(index(l, c - l))];
      result[index(l, r - l)] = glm::vec3(turned);
    }
  return result;
}

ShRgb projectCube(int order, std::span<const glm::vec3> texels, int size) {
  checkOrder(order);
  checkTexels("cube projection", texels.size(), 6LL * size, size);
  const GaussLegendre<double> rule(std::clamp(32 / size, 2, 16));
  std::array<glm::dvec3, kMaxCoefficients> sum{};
  const glm::vec3* texel = texels.data();
  for (int face = 0; face < 6; ++face)
    for (int row = 0; row < size; ++row)
      for (int column = 0; column < size; ++column, ++texel) {
        const Values basis = texelIntegral(order, face, column, row, size, rule);
        for (std::size_t i = 0; i < static_cast<std::size_t>(coefficientCount(order)); ++i)
          sum[i] += glm::dvec3(*texel) * basis[i];
      }
  ShRgb result(order);
  for (int i = 0; i < result.size(); ++i) result[i] = glm::vec3(sum[static_cast<std::size_t>(i)]);
  return result;
}

float equirectangularSolidAngle(int row, int width, int height) {
  const RowEdges edges = rowEdges(row, height);
  return static_cast<float>(2.0 * exact::kPi / width * (edges.top - edges.bottom));
}

float cubeSolidAngle(int column, int row, int size) {
  return static_cast<float>(texelSolidAngle(column, row, size));
}

glm::vec3 cubeDirection(int face, float u, float v) {
  const float s = 2.0f * u - 1.0f, t = 2.0f * v - 1.0f;
  glm::vec3 direction(0.0f);
  switch (face) {
    case 0:
      direction = {1.0f, -t, -s};
      break;
    case 1:
      direction = {-1.0f, -t, s};
      break;
    case 2:
      direction = {s, 1.0f, t};
      break;
    case 3:
      direction = {s, -1.0f, -t};
      break;
    case 4:
      direction = {s, -t, 1.0f};
      break;
    case 5:
      direction = {-s, -t, -1.0f};
      break;
    default:
      throw Error("cube projection", "face " + std::to_string(face) + ", expected 0 to 5");
  }
  return glm::normalize(direction);
}

}  // namespace gloam::sh
