// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "math/sampling.h"
#include "math/sh_constants.h"
#include "math/sh_log_exp.h"

namespace gloam::sh {
namespace {

double length(const Sh& f) {
  return std::sqrt(static_cast<double>(dot(f, f)));
}

Sh difference(Sh f, const Sh& g) {
  for (int i = 0; i < f.size(); ++i) f[i] -= g[i];
  return f;
}

Sh constant(int order, float value) {
  Sh f(order);
  f[0] = value * kShZonal0;
  return f;
}

/// 1 and a function with values of that size about it.
Sh positiveFunction(int order, float contrast, sampling::Rng& random) {
  Sh f = constant(order, 1.0f);
  for (int i = 1; i < f.size(); ++i) f[i] = contrast * (random.next() - 0.5f);
  return f;
}

Sh zonalToSh(const Zh& zonal, const glm::vec3& axis) {
  return rotateZonal(zonal, axis);
}

TEST(ShLog, LogOfAConstantIsItsLog) {
  for (int order = 1; order <= kMaxOrder; ++order)
    for (const float value : {0.01f, 1.0f, 1.0000001f, 7.5f}) {
      const Sh log = logarithm(constant(order, value));
      const Zh zonal = logarithmZonal({order, {value * kShZonal0}});
      EXPECT_NEAR(log[0], std::log(value) * kShZonal0, 2e-6f * (1.0f + std::abs(log[0])));
      EXPECT_NEAR(zonal[0], log[0], 2e-6f * (1.0f + std::abs(log[0])));
      for (int i = 1; i < log.size(); ++i) EXPECT_NEAR(log[i], 0.0f, 2e-6f);
    }
}

TEST(ShLog, ExponentialUndoesIt) {
  // exp(log f) = f up to what truncated products lose: the third order of the contrast and beyond.
  sampling::Rng random(1);
  for (int order = 2; order <= kMaxOrder; ++order)
    for (const float contrast : {0.05f, 0.3f}) {
      const Sh f = positiveFunction(order, contrast, random), log = logarithm(f);
      const double size = length(difference(f, constant(order, 1.0f)));
      EXPECT_LT(length(difference(expNumeric(log), f)), 0.1 * contrast * size) << order;
      EXPECT_LT(length(difference(expQuadratic(log), f)), 0.02 * size + 0.002) << order;
      EXPECT_LT(length(difference(expHybrid(log), f)), 0.15 * size) << order;
    }
}

TEST(ShLog, IsThePointwiseLogOfSmoothFunctions) {
  // A function of order 2 seen at order 6: its log has little beyond band 5, so truncation hardly matters.
  sampling::Rng random(2);
  const Sh f = truncated(positiveFunction(2, 0.8f, random), 6);
  const Sh want = project(6, [&](const glm::vec3& d) { return std::log(valueAt(f, d)); });
  EXPECT_LT(length(difference(logarithm(f), want)), 0.003 * length(want));
}

TEST(ShLog, ZonalFormEqualsTheGeneralOne) {
  for (int order = 1; order <= kMaxOrder; ++order)
    for (const float half_angle : {0.05f, 0.4f, 0.9f, 1.2f, 1.5707963f, 2.3f})
      for (const glm::vec3& axis : {glm::vec3(0, 0, 1), glm::normalize(glm::vec3(1, -2, 0.5f))}) {
        Sh visible = disc(order, axis, half_angle);
        visible *= -1.0f;
        visible[0] += kShZonal0;
        const Sh want = logarithm(visible), got = zonalToSh(logBlocker(order, half_angle), axis);
        EXPECT_LT(length(difference(got, want)), 1e-5 * (1.0 + length(want)))
            << "order " << order << ", half-angle " << half_angle;
      }
}

TEST(ShLog, TurnsWithItsFunction) {
  sampling::Rng random(3);
  const glm::mat3 turn = sampling::frame(sampling::uniformSphere(random.next2()));
  for (int order = 2; order <= kMaxOrder; ++order) {
    const Sh f = positiveFunction(order, 0.9f, random);  // clamped eigenvalues, too
    const Sh want = rotate(turn, logarithm(f));
    EXPECT_LT(length(difference(logarithm(rotate(turn, f)), want)), 1e-4 * length(want));
  }
}

TEST(ShLog, SmallBlockersAreSubtracted) {
  // log(1 - d) = -d where d is small.
  for (int order = 3; order <= kMaxOrder; ++order) {
    const float half_angle = 0.01f;
    const Zh log = logBlocker(order, half_angle), disc = discZonal(order, half_angle);
    for (int l = 0; l < order; ++l) EXPECT_NEAR(log[l], -disc[l], 0.003f * disc[l]) << order << ' ' << l;
    for (const float value : logBlocker(order, 0.0f).c) EXPECT_EQ(value, 0.0f);
  }
}

TEST(ShLog, LargeBlockersStayFinite) {
  for (int order = 3; order <= kMaxOrder; ++order) {
    Zh before = logBlocker(order, 1.0f);
    for (float half_angle = 1.01f; half_angle < 1.5708f; half_angle += 0.01f) {
      const Zh log = logBlocker(order, half_angle);
      double step = 0.0;
      for (int l = 0; l < order; ++l) step = std::max(step, std::abs(double(log[l]) - before[l]));
      EXPECT_LT(step, 0.5) << "order " << order << ", half-angle " << half_angle;
      // Nowhere darker than the clamp allows, and dark on its axis.
      EXPECT_GT(log[0], std::log(kLogClamp) * kShZonal0);
      EXPECT_LT(valueAt(zonalToSh(log, {0, 0, 1}), {0, 0, 1}), -1.5f);
      before = log;
    }
  }
}

TEST(ShLog, TableIsCloseToWhatItTabulates) {
  const double tolerance[] = {0.003, 0.003, 0.017, 0.017};
  for (int order = 3; order <= kMaxOrder; ++order) {
    const LogBlockerTable table = makeLogBlockerTable(order, 256);
    ASSERT_EQ(table.entries.size(), 256u);
    double worst = 0.0;
    for (int i = 1; i <= 400; ++i) {
      const float alpha = 1.0f / 15.0f + static_cast<float>(i) / 400.0f * (14.0f / 15.0f);
      const Zh want = logBlocker(order, std::asin(std::min(1.0f, alpha))), got = table.at(alpha);
      double error = 0.0, size = 0.0;
      for (int l = 0; l < order; ++l) {
        error += std::pow(double(got[l]) - want[l], 2);
        size += std::pow(double(want[l]), 2);
      }
      worst = std::max(worst, std::sqrt(error / size));
    }
    RecordProperty(fmt::format("worst_relative_error_{}", order), fmt::format("{:.4f}", worst));
    EXPECT_LT(worst, tolerance[order - 3]) << order;
    for (const float value : table.at(0.0f).c) EXPECT_EQ(value, 0.0f);
    EXPECT_EQ(table.at(2.0f)[0], table.entries.back()[0]);
  }
  for (const float alpha : {0.0f, 1e-4f, 0.3f, 0.99f, 1.0f})
    EXPECT_NEAR(logBlockerAlpha(logBlockerCoordinate(alpha)), alpha, 2e-7f);
}

TEST(ShLog, HigherClampIsShallower) {
  EXPECT_GT(logBlocker(4, 1.3f, 0.2f)[0], logBlocker(4, 1.3f, 0.02f)[0]);
  EXPECT_GT(logBlocker(4, 1.3f, 0.02f)[0], logBlocker(4, 1.3f, 0.001f)[0]);
}

TEST(ShLog, BadArgumentsAreErrors) {
  EXPECT_THROW(logarithm(Sh()), Error);
  EXPECT_THROW(logarithm(constant(3, -1.0f)), Error);
  EXPECT_THROW(logarithm(constant(3, 0.0f)), Error);
  EXPECT_THROW(logarithm(constant(3, std::numeric_limits<float>::quiet_NaN())), Error);
  EXPECT_THROW(logarithm(constant(3, 1.0f), 0.0f), Error);
  EXPECT_THROW(logarithm(constant(3, 1.0f), 1.5f), Error);
  EXPECT_THROW(logarithmZonal(Zh{}), Error);
  EXPECT_THROW(logBlocker(4, 3.14159f), Error);
  EXPECT_THROW(makeLogBlockerTable(4, 1), Error);
  EXPECT_THROW(makeLogBlockerTable(4, 1 << 20), Error);
  EXPECT_THROW(makeLogBlockerTable(7), Error);
  EXPECT_THROW(expNumeric(constant(3, std::numeric_limits<float>::infinity())), Error);
}

}  // namespace
}  // namespace gloam::sh
