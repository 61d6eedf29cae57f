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

std::array<sh::Sh, kEmissionDirections> voronoiSums() {
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

std::vector<glm::vec4> averageTable(Average average) {
  std::vector<glm::vec4> rows;
  for (int i = 0; i < kLogEntries; ++i)
    rows.push_back(averageWeights(average, sh::logBlockerAlpha(float(i) / float(kLogEntries - 1))));
  return rows;
}

std::vector<glm::vec4> logVisibilityTable() {
  const sh::LogBlockerTable table = sh::makeLogBlockerTable(kOrder, kLogEntries);
  std::vector<glm::vec4> rows;
  for (const sh::Zh& entry : table.entries) {
    glm::vec4 row;
    for (int l = 0; l < kOrder; ++l) row[l] = entry[l] * sh::zonalFactor(l);
    rows.push_back(row);
  }
  return rows;
}

glm::vec4 discWeights(float a) {
  const float a2 = a * a, c2 = std::max(0.0f, 1.0f - a2), c = std::sqrt(c2), pi = float(kPi);
  return {2.0f * pi * a2 / (1.0f + c), pi * a2, pi * a2 * c, 0.25f * pi * a2 * (5.0f * c2 - 1.0f)};
}

LightRows lightRows(const sh::ShRgb& light) {
  LightRows rows{};
  for (int channel = 0; channel < 3; ++channel) {
    sh::Sh one(light.order);
    for (int i = 0; i < light.size(); ++i) one[i] = light[i][channel];
    const sh::ShMatrix matrix = sh::productMatrix(one, 3, kOrder);
    for (int i = 0; i < 16; ++i) {
      for (int j = 0; j < 9; ++j) {
        const int band = j == 0 ? 0 : j < 4 ? 1 : 2;
        rows.shade[9 * i + j][channel] = matrix.at(i, j) * sh::clampedCosineFactor(band);
      }
    }
  }
  return rows;
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
