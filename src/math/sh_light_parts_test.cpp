// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "math/sh_light_parts.h"

#include <gtest/gtest.h>

#include "math/sampling.h"

namespace gloam::sh {
namespace {

ShRgb sunAndSky(const glm::vec3& direction, const glm::vec3& sun) {
  ShRgb light = gradientSky(6, {0.2f, 0.4f, 0.9f}, {0.5f, 0.6f, 0.8f}, {0.2f, 0.2f, 0.2f});
  light += colored(directionalLight(6, direction), sun);
  return light;
}

TEST(ShLightParts, ASunInASkyIsFound) {
  const glm::vec3 sun(3.0f, 2.0f, 1.0f);
  for (const glm::vec3& d : sampling::fibonacciSphere(40)) {
    const ShRgb light = sunAndSky(d, sun);
    const LightParts parts = lightParts(light, 4);
    // The horizon's bend is in the highest bands, too, but little of it.
    EXPECT_GT(glm::dot(parts.direction, d), 0.9998f);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(parts.peak[c] / sun[c], 1.0f, 0.05f);
  }
}

TEST(ShLightParts, PartsSumToTheLightAndTurnWithIt) {
  const ShRgb light = sunAndSky(glm::normalize(glm::vec3(0.3f, 0.5f, -0.6f)), {2.0f, 1.5f, 1.0f});
  const LightParts parts = lightParts(light, 4);
  ShRgb sum = parts.rest;
  sum += colored(directionalLight(4, parts.direction), parts.peak);
  for (int i = 0; i < 16; ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[i][c], light[i][c], 1e-5f);
  EXPECT_EQ(parts.rest.order, 4);
  const glm::mat3 turn(0, 1, 0, 0, 0, 1, 1, 0, 0);
  const LightParts turned = lightParts(rotate(turn, light), 4);
  EXPECT_LT(glm::distance(turned.direction, turn * parts.direction), 1e-3f);
  EXPECT_LT(glm::distance(turned.peak, parts.peak), 1e-3f);
}

// Four parts in five of the sun's ringing goes with the peak.
TEST(ShLightParts, TheRestHardlyRings) {
  const ShRgb light = sunAndSky(glm::normalize(glm::vec3(0.3f, 0.5f, -0.6f)), glm::vec3(3.0f));
  const LightParts parts = lightParts(light, 4);
  const auto least = [](const ShRgb& f) {
    Sh red(f.order);
    for (int i = 0; i < f.size(); ++i) red[i] = f[i].r;
    return minimum(red).value;
  };
  EXPECT_LT(least(light), -0.3f);
  EXPECT_GT(least(parts.rest), 0.2f * least(truncated(light, 4)));
}

TEST(ShLightParts, WhatIsBroadHasNoPeak) {
  const LightParts white = lightParts(constantSky(6, glm::vec3(1.0f)), 4);
  EXPECT_LT(glm::length(white.peak), 1e-4f);
  const LightParts none = lightParts(ShRgb(6), 4);
  EXPECT_EQ(none.peak, glm::vec3(0.0f));
  EXPECT_NEAR(glm::length(none.direction), 1.0f, 1e-5f);
  ShRgb negative = colored(directionalLight(6, {0, 1, 0}), glm::vec3(-1.0f));
  for (int c = 0; c < 3; ++c) EXPECT_GE(lightParts(negative, 4).peak[c], 0.0f);
}

TEST(ShLightParts, TooFewBandsAreRefused) {
  EXPECT_THROW(lightParts(ShRgb(3), 4), Error);
  EXPECT_THROW(lightParts(ShRgb(6), 7), Error);
}

}  // namespace
}  // namespace gloam::sh
