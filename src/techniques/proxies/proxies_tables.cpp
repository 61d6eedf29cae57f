// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Govindaraju, Nowrouzezahrai, Snyder 2007, "Image-based proxy accumulation for real-time soft global illumination":
// eq. 3 to 5 (log visibility), 14 and its closed form (average over a sphere's disc), 16 (exact operator), 10 (shade).
#include "techniques/proxies/proxies_tables.h"

#include <cmath>

#include "frame/field_shade.h"
#include "frame/light_peak.h"
#include "math/sh_log_exp.h"

namespace gloam::proxies {

namespace {

constexpr double kPi = 3.14159265358979323846;

/// y_lm with m >= 0 at azimuth 0.
void basisAtAzimuth0(double x, double z, double y[3][3]) {
  y[0][0] = 0.28209479177387814;
  y[1][0] = 0.4886025119029199 * z, y[1][1] = 0.4886025119029199 * x;
  y[2][0] = 0.31539156525252005 * (3.0 * z * z - 1.0), y[2][1] = 1.0925484305920792 * x * z;
  y[2][2] = 0.5462742152960396 * x * x;
}

}  // namespace

std::vector<glm::vec4> logVisibilityTable() {
  const sh::LogBlockerTable table = sh::makeLogBlockerTable(kShadowOrder, kLogEntries);
  std::vector<glm::vec4> rows;
  for (const sh::Zh& entry : table.entries) rows.push_back(frame::bandFactors(entry));
  return rows;
}

std::vector<float> blockedAloneTable() {
  const sh::LogBlockerTable table = sh::makeLogBlockerTable(kShadowOrder, kLogEntries);
  std::vector<float> blocked;
  for (int method = kExpSeries; method <= kExpQuadratic; ++method) {
    for (const sh::Zh& entry : table.entries) {
      const sh::Sh log = sh::rotateZonal(entry, glm::vec3(0.0f, 0.0f, 1.0f));
      const sh::Sh seen = method == kExpSeries   ? sh::expSeries(log, kExpTerms)
                          : method == kExpLinear ? sh::expLinear(log)
                          : method == kExpHybrid ? sh::expHybrid(log)
                                                 : sh::expQuadratic(log);
      blocked.push_back(std::max(0.0f, sh::zonalFactor(0) - seen[0]) * sh::zonalFactor(0));
    }
  }
  return blocked;
}

sh::Zh averageOperator(float sin_half_angle) {
  const double d = 1.0 / double(sin_half_angle), b = std::sqrt(std::max(0.0, d * d - 1.0));
  sh::Zh zonal{.order = 3};
  zonal[0] = float(0.5 / std::sqrt(kPi));
  zonal[1] =
      float(-std::sqrt(3.0) * (2 * d * d * d - 2 * d * d * b - b + 1) / (6 * std::sqrt(kPi) * d * (d - b)));
  zonal[2] = float(std::sqrt(5.0) * (6 * std::pow(d, 5) - 6 * b * std::pow(d, 4) - 3 * b * d * d - b + 4) /
                   (20 * std::sqrt(kPi) * d * d * (d - b)));
  return zonal;
}

sh::Zh averageOperatorFit(float a) {
  sh::Zh zonal{.order = 3};
  zonal[0] = 0.28209479f;
  zonal[1] = (0.08432f * a - 0.25073f) * a - 0.32494f;
  zonal[2] = ((-0.22230f * a + 0.22502f) * a + 0.47398f) * a + 0.15950f;
  return zonal;
}

ExactOperator exactOperator(float sin_half_angle) {
  const double a = std::max(double(sin_half_angle), 1e-4);
  const double cos_limit = std::sqrt(std::max(0.0, 1.0 - a * a));
  double m0[3][3] = {}, m1[2][2] = {}, m2 = 0.0, solid_angle = 0.0;
  // s_z = 1 - (1 - cos) (1 - t^2) takes the square root at the disc's edge out of the integrand.
  constexpr int kSteps = 256;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (double(i) + 0.5) / kSteps;
    const double z = cos_limit + (1.0 - cos_limit) * t * t;
    const double weight = (1.0 - cos_limit) * 2.0 * t / kSteps;
    const double x = std::sqrt(std::max(0.0, 1.0 - z * z));
    const double distance = z - std::sqrt(std::max(0.0, z * z - cos_limit * cos_limit));
    double y[3][3], yq[3][3];
    basisAtAzimuth0(x, z, y);
    basisAtAzimuth0(distance * x / a, (distance * z - 1.0) / a, yq);
    solid_angle += 2.0 * kPi * weight;
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) m0[j][k] += 2.0 * kPi * weight * y[j][0] * yq[k][0];
    }
    for (int j = 0; j < 2; ++j) {
      for (int k = 0; k < 2; ++k) m1[j][k] += kPi * weight * y[j + 1][1] * yq[k + 1][1];
    }
    m2 += kPi * weight * y[2][2] * yq[2][2];
  }
  ExactOperator result{};
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < 3; ++k) result.m0[j][k] = float(m0[j][k] / solid_angle);
  }
  for (int j = 0; j < 2; ++j) {
    for (int k = 0; k < 2; ++k) result.m1[j][k] = float(m1[j][k] / solid_angle);
  }
  result.m2 = float(m2 / solid_angle);
  return result;
}

std::vector<glm::vec4> exactOperatorTable() {
  std::vector<glm::vec4> rows;
  for (int i = 0; i < kOperatorEntries; ++i) {
    const ExactOperator m = exactOperator(sh::logBlockerAlpha(float(i) / float(kOperatorEntries - 1)));
    rows.emplace_back(m.m0[0][0], m.m0[0][1], m.m0[0][2], m.m0[1][0]);
    rows.emplace_back(m.m0[1][1], m.m0[1][2], m.m0[2][0], m.m0[2][1]);
    rows.emplace_back(m.m0[2][2], m.m1[0][0], m.m1[0][1], m.m1[1][0]);
    rows.emplace_back(m.m1[1][1], m.m2, 0.0f, 0.0f);
  }
  return rows;
}

ProxyLight proxyLight(const sh::ShRgb& light) {
  ProxyLight row{};
  const sh::ShRgb leaving =
      sh::convolve(sh::truncated(light, kIndirectOrder), sh::clampedCosine(kIndirectOrder));
  for (int i = 0; i < 9; ++i) row.leaving[i] = leaving[i] / float(kPi);
  const float b = 0.546274215f, c = 0.315391565f;
  row.tensor[0] = -c * row.leaving[6] + b * row.leaving[8];
  row.tensor[1] = -c * row.leaving[6] - b * row.leaving[8];
  row.tensor[2] = 2.0f * c * row.leaving[6];
  row.tensor[3] = b * row.leaving[4];
  row.tensor[4] = b * row.leaving[5];
  row.tensor[5] = b * row.leaving[7];
  frame::shadeRows(light, row.shade);
  return row;
}

ProxyLight proxyLight(const sh::ShRgb& light, const sh::LightParts& parts) {
  ProxyLight row = proxyLight(light);
  frame::shadeRows(parts.rest, row.shade);
  row.peak = frame::lightPeak(parts);
  return row;
}

}  // namespace gloam::proxies
