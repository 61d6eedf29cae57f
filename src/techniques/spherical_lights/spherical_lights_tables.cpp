// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Guerrero, Jeschke, Wimmer 2008, "Real-time indirect illumination and soft shadows in dynamic scenes using spherical lights": eq. 10
// (Voronoi sums), 16 to 18 (average radiance). Eq. 17 is max(0, (cos - a) / sqrt(1 + a^2 - 2 a cos)), a = sin of the half-angle: the
// cosine at a point of the sphere toward the receiver. Seen from there, a point counts by its solid angle, cosine over distance
// squared: the exponent becomes 3/2.
#include "techniques/spherical_lights/spherical_lights_tables.h"

#include <algorithm>
#include <cmath>

#include "frame/field_shade.h"
#include "math/sh_log_exp.h"
#include "techniques/spherical_lights/spherical_lights_prepare.h"

namespace gloam::spherical_lights {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kOrder = kEmissionOrder;

}  // namespace

std::array<glm::vec3, kEmissionDirections> geodesicDirections() {
  const float golden = 1.6180339887f;
  std::array<glm::vec3, 12> corners;
  std::size_t count = 0;
  for (const float a : {-1.0f, 1.0f}) {
    for (const float b : {-golden, golden}) {
      corners[count++] = glm::normalize(glm::vec3(0, a, b));
      corners[count++] = glm::normalize(glm::vec3(a, b, 0));
      corners[count++] = glm::normalize(glm::vec3(b, 0, a));
    }
  }
  const auto neighbours = [&](std::size_t i, std::size_t j) {
    return i != j && glm::dot(corners[i], corners[j]) > 0.4f;
  };
  std::array<glm::vec3, kEmissionDirections> all;
  std::size_t at = 0;
  for (const glm::vec3& corner : corners) all[at++] = corner;
  for (std::size_t i = 0; i < 12; ++i) {
    for (std::size_t j = 0; j < 12; ++j) {
      if (neighbours(i, j)) all[at++] = glm::normalize(2.0f * corners[i] + corners[j]);
    }
  }
  for (std::size_t i = 0; i < 12; ++i) {
    for (std::size_t j = i + 1; j < 12; ++j) {
      for (std::size_t k = j + 1; k < 12; ++k) {
        if (neighbours(i, j) && neighbours(j, k) && neighbours(i, k))
          all[at++] = glm::normalize(corners[i] + corners[j] + corners[k]);
      }
    }
  }
  return all;
}

namespace {

std::array<sh::Sh, kEmissionDirections> findVoronoiSums() {
  constexpr int kRows = 256;  // of equal area in cos, twice as many columns
  const auto& ways = emissionDirections();
  std::array<std::array<double, 16>, kEmissionDirections> sums{};
  for (int row = 0; row < kRows; ++row) {
    const double z = 1.0 - 2.0 * (row + 0.5) / kRows, side = std::sqrt(1.0 - z * z);
    for (int column = 0; column < 2 * kRows; ++column) {
      const double angle = kPi * (column + 0.5) / kRows;
      const glm::vec3 way(float(side * std::cos(angle)), float(side * std::sin(angle)), float(z));
      std::size_t nearest = 0;
      for (std::size_t j = 1; j < ways.size(); ++j) {
        if (glm::dot(ways[j], way) > glm::dot(ways[nearest], way)) nearest = j;
      }
      const sh::Sh y = sh::evaluate(kOrder, way);
      for (int i = 0; i < 16; ++i) sums[nearest][std::size_t(i)] += double(y[i]);
    }
  }
  std::array<sh::Sh, kEmissionDirections> result;
  for (std::size_t j = 0; j < ways.size(); ++j) {
    result[j] = sh::Sh(kOrder);
    for (int i = 0; i < 16; ++i)
      result[j][i] = float(sums[j][std::size_t(i)] * 4.0 * kPi / (2.0 * kRows * kRows));
  }
  return result;
}

}  // namespace

const std::array<sh::Sh, kEmissionDirections>& voronoiSums() {
  static const auto sums = findVoronoiSums();
  return sums;
}

glm::vec4 averageWeights(Average average, float sin_half_angle) {
  const double a = std::clamp(double(sin_half_angle), 0.0, 1.0 - 1e-6);
  constexpr int kSteps = 512;
  double sums[4] = {};
  for (int i = 0; i < kSteps; ++i) {
    // cos = a (where the receiver's tangent touches the sphere) to 1, 1 - t^4 of the way: a sphere next to the receiver shows
    // little of itself.
    const double t = (i + 0.5) / kSteps, x = 1.0 - (1.0 - a) * t * t * t * t;
    const double squared = 1.0 + a * a - 2.0 * a * x;
    const double weight = 4.0 * t * t * t * (x - a) /
                          (average == Average::kArea ? std::sqrt(squared) : squared * std::sqrt(squared));
    const double p[4] = {1.0, x, 1.5 * x * x - 0.5, (2.5 * x * x - 1.5) * x};
    for (int l = 0; l < 4; ++l) sums[l] += weight * p[l];
  }
  return {1.0f, float(sums[1] / sums[0]), float(sums[2] / sums[0]), float(sums[3] / sums[0])};
}

glm::vec4 logWeights(float sin_half_angle) {
  return frame::bandFactors(sh::logBlocker(kOrder, std::asin(std::clamp(sin_half_angle, 0.0f, 1.0f))));
}

namespace {

/// Through the values at Chebyshev's points, which is within a small factor of the best there is; then in powers.
template <class Function>
Fit fitOf(float from, float to, const Function& function) {
  std::array<glm::dvec4, kFitTerms> chebyshev{};
  for (int k = 0; k < kFitTerms; ++k) {
    const double angle = kPi * (k + 0.5) / kFitTerms;
    const float t = from + (to - from) * float(0.5 + 0.5 * std::cos(angle));
    const glm::dvec4 value(function(sh::logBlockerAlpha(t)));
    for (int n = 0; n < kFitTerms; ++n)
      chebyshev[std::size_t(n)] += value * std::cos(n * angle) * ((n == 0 ? 1.0 : 2.0) / kFitTerms);
  }
  // T_0 = 1, T_1 = x, T_n = 2 x T_n-1 - T_n-2.
  std::array<double, kFitTerms> before{1.0}, now{0.0, 1.0};
  std::array<glm::dvec4, kFitTerms> powers{};
  powers[0] = chebyshev[0];
  for (std::size_t n = 1; n < kFitTerms; ++n) {
    for (std::size_t i = 0; i <= n; ++i) powers[i] += chebyshev[n] * now[i];
    std::array<double, kFitTerms> next{};
    for (std::size_t i = 0; i + 1 < kFitTerms; ++i) next[i + 1] = 2.0 * now[i];
    for (std::size_t i = 0; i < kFitTerms; ++i) next[i] -= before[i];
    before = now, now = next;
  }
  Fit fit;
  for (std::size_t i = 0; i < kFitTerms; ++i) fit[i] = glm::vec4(powers[i]);
  return fit;
}

glm::vec4 valueOf(const Fit& fit, float x) {
  glm::vec4 sum = fit[kFitTerms - 1];
  for (int i = kFitTerms - 2; i >= 0; --i) sum = sum * x + fit[std::size_t(i)];
  return sum;
}

}  // namespace

Fit averageFit(Average average) {
  return fitOf(0.0f, 1.0f, [&](float a) { return averageWeights(average, a); });
}
glm::vec4 averageFitted(const Fit& fit, float sin_half_angle) {
  return valueOf(fit, 2.0f * sh::logBlockerCoordinate(sin_half_angle) - 1.0f);
}

LogFit logFit() {
  const auto scaled = [](float a) { return logWeights(a) / (a * a); };
  return {fitOf(0.0f, kLogSplit, scaled), fitOf(kLogSplit, 1.0f, scaled)};
}
glm::vec4 logFitted(const LogFit& fit, float sin_half_angle) {
  const float t = sh::logBlockerCoordinate(sin_half_angle);
  const float x =
      t > kLogSplit ? 2.0f * (t - kLogSplit) / (1.0f - kLogSplit) - 1.0f : 2.0f * t / kLogSplit - 1.0f;
  return sin_half_angle * sin_half_angle * valueOf(fit[t > kLogSplit ? 1 : 0], x);
}

glm::vec4 discWeights(float a) {
  const float a2 = a * a, c2 = std::max(0.0f, 1.0f - a2), c = std::sqrt(c2), pi = float(kPi);
  return {2.0f * pi * a2 / (1.0f + c), pi * a2, pi * a2 * c, 0.25f * pi * a2 * (5.0f * c2 - 1.0f)};
}

void bandRotation(const glm::mat3& matrix, float out[83]) {
  const sh::Rotation rotation = sh::makeRotation(kOrder, matrix);
  for (int l = 1; l < kOrder; ++l) {
    const int size = 2 * l + 1;
    for (int column = 0; column < size; ++column) {
      sh::Sh unit(kOrder);
      unit[l * l + column] = 1.0f;
      const sh::Sh turned = sh::rotate(rotation, unit);
      for (int row = 0; row < size; ++row) out[row * size + column] = turned[l * l + row];
    }
    out += size * size;
  }
}

}  // namespace gloam::spherical_lights
