// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Integrals of products of basis functions by quadrature that is exact for polynomials of their degree: Gauss-Legendre in
// z, equal steps around it. Basis: normalised associated Legendre functions by their recursion in l, divided by sin^m, times
// (x + i y)^m.
#include "math/sh_high_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>

#include "math/quadrature.h"

namespace gloam::sh {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct SpherePoint {
  glm::dvec3 direction;
  double weight;
};

/// Exact for polynomials up to that degree.
std::vector<SpherePoint> spherePoints(int degree) {
  const GaussLegendre<double> rings(degree / 2 + 1);
  const int steps = degree + 1;
  std::vector<SpherePoint> points;
  for (std::size_t r = 0; r < rings.nodes.size(); ++r) {
    const double z = rings.nodes[r], radius = std::sqrt(std::max(0.0, 1.0 - z * z));
    for (int s = 0; s < steps; ++s) {
      const double phi = 2.0 * kPi * (s + 0.5) / steps;
      points.push_back(
          {{radius * std::cos(phi), radius * std::sin(phi), z}, rings.weights[r] * 2.0 * kPi / steps});
    }
  }
  return points;
}

int bandOf(int i) {
  return int(std::sqrt(double(i) + 0.5));
}

void checkOrder(int order, int most) {
  if (order < 1 || order > most) {
    throw Error("spherical harmonics",
                "order " + std::to_string(order) + "; 1 to " + std::to_string(most) + " are known");
  }
}

std::size_t blockStart(int l) {  // sum of (2 k + 1)^2, k < l
  return std::size_t(l) * std::size_t(4 * l * l - 1) / 3;
}

}  // namespace

void evaluateHigh(int order, const glm::dvec3& d, std::span<double> values) {
  checkOrder(order, kMaxHighOrder);
  double sector = std::sqrt(0.25 / kPi), cosine = 1.0, sine = 0.0;  // p_mm, and Re, Im of (x + i y)^m
  for (int m = 0; m < order; ++m) {
    if (m > 0) {
      sector *= std::sqrt((2.0 * m + 1.0) / (2.0 * m));
      const double next = d.x * cosine - d.y * sine;
      sine = d.x * sine + d.y * cosine;
      cosine = next;
    }
    double before = 0.0, now = sector;
    for (int l = m; l < order; ++l) {
      if (l > m) {
        const double square = double(l) * l - double(m) * m, last = double(l - 1) * (l - 1);
        const double a = std::sqrt((4.0 * l * l - 1.0) / square);
        const double b = l == m + 1 ? 0.0 : std::sqrt((last - double(m) * m) / (4.0 * last - 1.0));
        const double next = a * (d.z * now - b * before);
        before = now;
        now = next;
      }
      const double scale = m == 0 ? 1.0 : std::sqrt(2.0);
      values[std::size_t(index(l, m))] = scale * now * cosine;
      if (m > 0) values[std::size_t(index(l, -m))] = scale * now * sine;
    }
  }
}

void hemisphereHigh(int order, const glm::vec3& normal, std::span<float> coefficients) {
  std::array<double, kMaxHighCoefficients> y;
  evaluateHigh(order, glm::normalize(glm::dvec3(normal)), y);
  // Integral of P_l from 0 to 1: (P_{l-1}(0) - P_{l+1}(0)) / (2l + 1); times 2 pi it is the factor of y_lm(N).
  std::array<double, kMaxHighOrder + 2> at_zero{1.0, 0.0};
  for (int l = 2; l < order + 1; ++l) at_zero[std::size_t(l)] = -(l - 1.0) / l * at_zero[std::size_t(l - 2)];
  for (int l = 0; l < order; ++l) {
    const double integral =
        l == 0 ? 1.0 : (at_zero[std::size_t(l - 1)] - at_zero[std::size_t(l + 1)]) / (2.0 * l + 1.0);
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
      coefficients[std::size_t(i)] = float(2.0 * kPi * integral * y[std::size_t(i)]);
    }
  }
}

Tripling::Tripling(int light_order, int field_order) : shape_{light_order, field_order} {
  const int order = visibilityOrder(), count = order * order;
  const std::vector<SpherePoint> points = spherePoints(2 * order - 2);
  // [k][point], the weight within the second factor.
  std::vector<double> y(std::size_t(count) * points.size());
  std::array<double, kMaxHighCoefficients> values;
  for (std::size_t p = 0; p < points.size(); ++p) {
    evaluateHigh(order, points[p].direction, values);
    for (std::size_t k = 0; k < std::size_t(count); ++k) y[k * points.size() + p] = values[k];
  }
  std::vector<double> pair(points.size());
  first_.push_back(0);
  for (int i = 0; i < shape_.rows(); ++i) {
    for (int j = 0; j < std::min(i + 1, shape_.columns()); ++j) {
      const double* yi = &y[std::size_t(i) * points.size()];
      const double* yj = &y[std::size_t(j) * points.size()];
      for (std::size_t p = 0; p < points.size(); ++p) pair[p] = points[p].weight * yi[p] * yj[p];
      // Zero outside the triangle rule, and where the sum of the three bands is odd.
      const int sum = bandOf(i) + bandOf(j), least = bandOf(i) - bandOf(j);
      for (int l = std::abs(least); l <= sum; l += 2) {
        for (int k = l * l; k < (l + 1) * (l + 1); ++k) {
          const double* yk = &y[std::size_t(k) * points.size()];
          double gamma = 0.0;
          for (std::size_t p = 0; p < points.size(); ++p) gamma += pair[p] * yk[p];
          if (std::abs(gamma) > 1.0e-9) entries_.push_back({std::uint32_t(k), float(gamma)});
        }
      }
      first_.push_back(std::uint32_t(entries_.size()));
    }
  }
}

const Tripling& Tripling::of(int light_order, int field_order) {
  checkOrder(field_order, kMaxOrder);
  checkOrder(light_order, field_order);
  static std::mutex mutex;
  static std::map<std::pair<int, int>, std::unique_ptr<const Tripling>> made;
  const std::lock_guard lock(mutex);
  auto& tripling = made[{light_order, field_order}];
  if (!tripling) tripling.reset(new Tripling(light_order, field_order));
  return *tripling;
}

void Tripling::expand(std::span<const float> visibility, std::span<float> packed) const {
  const std::size_t size = std::size_t(shape_.size());
  for (std::size_t e = 0; e < size; ++e) {
    float sum = 0.0f;
    for (std::uint32_t n = first_[e]; n < first_[e + 1] && entries_[n].k < visibility.size(); ++n) {
      sum += entries_[n].value * visibility[entries_[n].k];
    }
    packed[e] = sum;
  }
}

std::vector<glm::vec3> Tripling::lightMatrix(std::span<const glm::vec3> light, int columns) const {
  std::vector<glm::vec3> matrix(std::size_t(shape_.rows()) * std::size_t(columns), glm::vec3(0.0f));
  for (int i = 0; i < shape_.rows(); ++i) {
    for (int j = 0; j < shape_.columns(); ++j) {
      const std::size_t e = std::size_t(shape_.at(i, j));
      for (std::uint32_t n = first_[e]; n < first_[e + 1] && int(entries_[n].k) < columns; ++n) {
        matrix[std::size_t(i) * std::size_t(columns) + entries_[n].k] +=
            entries_[n].value * light[std::size_t(j)];
      }
    }
  }
  return matrix;
}

HighRotation::HighRotation(int order, const glm::mat3& matrix) : identity_(matrix == glm::mat3(1.0f)) {
  checkOrder(order, kMaxHighOrder);
  if (identity_) return;
  std::vector<double> sums(blockStart(order), 0.0);
  std::array<double, kMaxHighCoefficients> here, before;
  const glm::dmat3 inverse = glm::transpose(glm::dmat3(matrix));
  for (const SpherePoint& point : spherePoints(2 * order - 2)) {
    evaluateHigh(order, point.direction, here);
    evaluateHigh(order, glm::normalize(inverse * point.direction), before);
    for (int l = 0; l < order; ++l) {
      const std::size_t width = std::size_t(2 * l + 1), first = std::size_t(l * l);
      double* block = &sums[blockStart(l)];
      for (std::size_t r = 0; r < width; ++r) {
        for (std::size_t c = 0; c < width; ++c)
          block[r * width + c] += point.weight * here[first + r] * before[first + c];
      }
    }
  }
  blocks_.assign(sums.begin(), sums.end());
}

void HighRotation::apply(int order, const float* in, std::size_t in_stride, float* out,
                         std::size_t out_stride) const {
  for (int l = 0; l < order; ++l) {
    const std::size_t width = std::size_t(2 * l + 1), first = std::size_t(l * l);
    for (std::size_t r = 0; r < width; ++r) {
      float sum = 0.0f;
      if (identity_) {
        sum = in[(first + r) * in_stride];
      } else {
        const float* row = &blocks_[blockStart(l) + r * width];
        for (std::size_t c = 0; c < width; ++c) sum += row[c] * in[(first + c) * in_stride];
      }
      out[(first + r) * out_stride] = sum;
    }
  }
}

}  // namespace gloam::sh
