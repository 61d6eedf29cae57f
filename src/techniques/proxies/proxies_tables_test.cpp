// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/proxies/proxies_tables.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"
#include "techniques/proxies/proxies_coverage.h"

namespace gloam::proxies {
namespace {

constexpr float kPi = 3.14159265f;

/// Mean over the visible disc by rings of directions: the slow twin of PX-4.
sh::Zh averageByQuadrature(double a) {
  const double cosine = std::sqrt(1.0 - a * a);
  double sums[3] = {};
  constexpr int kRings = 200000;
  for (int i = 0; i < kRings; ++i) {
    const double t = (double(i) + 0.5) / kRings, z = cosine + (1.0 - cosine) * t;
    const double distance = z - std::sqrt(std::max(0.0, z * z - cosine * cosine));
    const double nz = (distance * z - 1.0) / a;
    sums[0] += 1.0, sums[1] += nz, sums[2] += 1.5 * nz * nz - 0.5;
  }
  sh::Zh zonal{.order = 3};
  for (int l = 0; l < 3; ++l)
    zonal[l] = float(sums[l] / kRings * std::sqrt((2.0 * l + 1.0) / (4.0 * double(kPi))));
  return zonal;
}

TEST(ProxiesTables, ClosedFormIsTheMeanOverTheDisc) {
  for (const float a : {0.05f, 0.2f, 0.5f, 0.8f, 0.99f}) {
    const sh::Zh want = averageByQuadrature(double(a)), got = averageOperator(a);
    for (int l = 0; l < 3; ++l) EXPECT_NEAR(got[l], want[l], 2e-4f) << "a " << a << " l " << l;
  }
}

// The paper says 0.00016 % and 0.00064 % of squared error; its sampling is not given.
TEST(ProxiesTables, PolynomialsFitAsThePaperSays) {
  double wrong[3] = {}, all[3] = {};
  for (int i = 1; i <= 999; ++i) {
    const float a = float(i) / 1000.0f;
    if (a < 0.02f) continue;
    const sh::Zh exact = averageOperator(a), fit = averageOperatorFit(a);
    for (int l = 1; l < 3; ++l) {
      wrong[l] += double(fit[l] - exact[l]) * double(fit[l] - exact[l]);
      all[l] += double(exact[l]) * double(exact[l]);
    }
  }
  EXPECT_LT(wrong[1] / all[1], 2 * 0.0000016);
  EXPECT_LT(wrong[2] / all[2], 2 * 0.0000064);
}

/// The function that the exact operator makes of light, integrated by brute force against y_jm.
TEST(ProxiesTables, ExactOperatorIsTheIntegralOverDirections) {
  const float a = 0.6f, cosine = 0.8f;
  const ExactOperator m = exactOperator(a);
  const std::vector<glm::vec3> ways = sampling::fibonacciSphere(400000);
  double sums[9][9] = {};
  double solid_angle = 0.0;
  for (const glm::vec3& s : ways) {
    if (s.z < cosine) continue;
    const float distance = s.z - std::sqrt(std::max(0.0f, s.z * s.z - cosine * cosine));
    const glm::vec3 normal = (distance * s - glm::vec3(0, 0, 1)) / a;
    const sh::Sh y = sh::evaluate(3, s), yq = sh::evaluate(3, normal);
    for (int j = 0; j < 9; ++j) {
      for (int k = 0; k < 9; ++k) sums[j][k] += double(y[j] * yq[k]);
    }
    solid_angle += 1.0;
  }
  const auto got = [&](int j, int k) { return sums[j][k] / solid_angle; };
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(m.m0[j][k], got(j * (j + 1), k * (k + 1)), 3e-4);
  }
  for (int j = 1; j < 3; ++j) {
    for (int k = 1; k < 3; ++k) {
      EXPECT_NEAR(m.m1[j - 1][k - 1], got(j * (j + 1) + 1, k * (k + 1) + 1), 3e-4);
      EXPECT_NEAR(m.m1[j - 1][k - 1], got(j * (j + 1) - 1, k * (k + 1) - 1), 3e-4);
    }
  }
  EXPECT_NEAR(m.m2, got(8, 8), 3e-4);
  EXPECT_NEAR(got(6, 3), 0.0, 1e-3);  // diagonal in m
}

TEST(ProxiesTables, WithoutProxiesShadeIsIrradiance) {
  const sh::ShRgb light =
      sh::colored(sh::directionalLight(4, glm::normalize(glm::vec3(1, 2, 0.5f))), {1, 2, 3});
  const ProxyLight row = proxyLight(light);
  for (const glm::vec3& n : sampling::fibonacciSphere(50)) {
    const sh::Sh y = sh::evaluate(3, n);
    glm::vec3 sum(0.0f);
    for (int j = 0; j < 9; ++j) sum += row.shade[j] * y[j] * sh::zonalFactor(0);
    const glm::vec3 want = sh::irradiance(light, n);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], want[c], 1e-4f);
  }
}

// A delta needs the paper's fixed factors at most; a sky that is the same everywhere far less.
TEST(ProxiesTables, ReachFollowsTheLight) {
  const Reach delta = reachOf(proxyLight(sh::colored(sh::directionalLight(4, {0, 1, 0}), glm::vec3(1.0f))));
  EXPECT_NEAR(delta.shadow, kFixedReach.shadow, 2.5f);
  const Reach sky = reachOf(proxyLight(sh::constantSky(4, glm::vec3(1.0f))));
  EXPECT_LT(sky.shadow, 0.85f * delta.shadow);
  EXPECT_GT(sky.shadow, 5.0f);  // a^2 = 4 / 256 overhead: 8
  EXPECT_GT(sky.indirect, 3.0f);
}

}  // namespace
}  // namespace gloam::proxies
