// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/sh.h>
#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"

namespace gloam::sh {
namespace {

float sampledMinimum(const Sh& f) {
  static const std::vector<glm::vec3> directions = sampling::fibonacciSphere(20000);
  float least = 1e30f;
  for (const glm::vec3& d : directions) least = std::min(least, valueAt(f, d));
  return least;
}

Sh withLambda(const Sh& f, double lambda) {
  Sh result = f;
  for (int l = 0; l < f.order; ++l)
    for (int m = -l; m <= l; ++m)
      result[index(l, m)] *= static_cast<float>(1.0 / (1.0 + lambda * l * l * (l + 1) * (l + 1)));
  return result;
}

Sh randomFunction(std::uint32_t seed, float mean) {
  sampling::Rng random(seed);
  Sh f(6);
  for (float& value : f.c) value = random.next() - 0.5f;
  f[0] = mean;
  return f;
}

TEST(ShWindow, FactorsAreTheirFormulas) {
  Sh ones(6);
  for (float& value : ones.c) value = 1.0f;
  const Sh hann = windowHann(ones, 6.0f), lanczos = windowLanczos(ones, 6.0f),
           narrow = windowHann(ones, 2.0f);
  EXPECT_EQ(hann[0], 1.0f);
  EXPECT_NEAR(hann[index(3, -2)], 0.5f, 1e-6f);
  EXPECT_NEAR(hann[index(5, 5)], 0.0669873f, 1e-6f);
  EXPECT_EQ(lanczos[0], 1.0f);
  EXPECT_NEAR(lanczos[index(3, 0)], 2.0f / 3.14159265f, 1e-6f);
  EXPECT_NEAR(narrow[index(1, 0)], 0.5f, 1e-6f);
  EXPECT_EQ(narrow[index(2, 0)], 0.0f);
  EXPECT_THROW(windowHann(ones, 0.0f), Error);
  EXPECT_THROW(windowLanczos(ones, -1.0f), Error);
}

TEST(ShWindow, MinimumIsFound) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const Sh f = randomFunction(seed, 0.2f);
    const Minimum least = minimum(f);
    EXPECT_LE(least.value, sampledMinimum(f) + 1e-5f) << seed;
    EXPECT_GT(least.value, sampledMinimum(f) - 0.01f) << seed;
    EXPECT_NEAR(valueAt(f, least.direction), least.value, 1e-5f) << seed;
  }
}

TEST(ShWindow, LeastWindowKeepsNonNegativeAndNoMore) {
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    const Sh f = randomFunction(seed, 1.5f), g = windowNonNegative(f);
    ASSERT_LT(minimum(f).value, 0.0f) << "this function needs no window; choose another";
    EXPECT_GE(sampledMinimum(g), -2e-6f);
    EXPECT_EQ(g[0], f[0]);
    const double lambda = (double(f[index(2, 1)]) / double(g[index(2, 1)]) - 1.0) / 36.0;
    EXPECT_LT(minimum(withLambda(f, 0.99 * lambda)).value, 0.0f) << "a lesser window would have done";
  }
}

TEST(ShWindow, DirectionalLightNeedsOneAndDiffuseLightNone) {
  const Sh sun = directionalLight(6, glm::normalize(glm::vec3(0.1f, 0.9f, 0.3f)));
  EXPECT_LT(minimum(sun).value, -0.1f);
  EXPECT_GE(sampledMinimum(windowNonNegative(sun)), -2e-6f);
  Sh soft = evaluate(4, {0, 1, 0});
  for (int i = 1; i < 16; ++i) soft[i] *= 0.06f;
  ASSERT_GT(minimum(soft).value, 0.0f);
  const Sh same = windowNonNegative(soft);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(same[i], soft[i]);
  Sh constant(6);
  constant[0] = 1.0f;
  EXPECT_EQ(windowNonNegative(constant)[0], 1.0f);
}

TEST(ShWindow, OneWindowForAllChannelsAndNegativeMeansAreLeft) {
  ShRgb f(4);
  sampling::Rng random(9);
  for (int i = 1; i < 16; ++i) f[i] = glm::vec3(random.next(), random.next(), random.next()) - 0.5f;
  f[0] = {1.5f, 3.0f, -1.0f};
  const ShRgb g = windowNonNegative(f);
  for (int channel = 0; channel < 2; ++channel) {
    Sh single(4);
    for (int i = 0; i < 16; ++i) single[i] = g[i][channel];
    EXPECT_GE(sampledMinimum(single), -2e-6f);
  }
  for (int i = 1; i < 16; ++i) EXPECT_NEAR(g[i].x * f[i].y, g[i].y * f[i].x, 1e-6f);
  Sh black(3);
  black[1] = 1.0f;
  EXPECT_EQ(windowNonNegative(black)[1], 1.0f);
}

}  // namespace
}  // namespace gloam::sh
