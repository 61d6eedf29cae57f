// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The rule for receivers in or near a sphere: values a person can derive, continuity, the shader's twin.
#include "spheres/receiver_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/sampling.h"

namespace gloam::spheres {
namespace {

// The shader's text as C++.
namespace glsl {
using namespace glm;  // NOLINT: vec3, dot, min … as in GLSL
#include "spheres/receiver_rule.glsl"
}  // namespace glsl

const glm::vec3 kUp(0.0f, 1.0f, 0.0f);

float seenSin(const glm::vec3& center, float radius, float bulge = 0.0f) {
  return seenSphere(glm::vec3(0.0f), kUp, center, radius, bulge).sin_half_angle;
}

TEST(ReceiverRule, LeavesSpheresAboveThePlane) {
  EXPECT_FLOAT_EQ(seenSin({3, 4, 0}, 1.0f), 0.2f);
  EXPECT_FLOAT_EQ(seenSin({0, 2, 0}, 2.0f), 1.0f);  // touches from above
}

TEST(ReceiverRule, DropsSpheresBelowIt) {
  EXPECT_EQ(seenSin({1, -2, 0}, 1.0f), 0.0f);
  EXPECT_EQ(seenSin({0, -1, 0}, 1.0f), 0.0f);
}

TEST(ReceiverRule, StandsWhatReachesThroughThePlaneOnIt) {
  // h = 0, r = 1, x = 3: a sphere of radius 1/2 at (3, 1/2).
  EXPECT_NEAR(seenSin({3, 0, 0}, 1.0f), 0.5f / std::sqrt(9.25f), 1e-6f);
  // Inside, at the centre: held at its value on crossing, x^2 = r^2 - h^2 = 1.
  EXPECT_NEAR(seenSin({0, 0, 0}, 1.0f), 0.5f / std::sqrt(1.25f), 1e-6f);
  EXPECT_NEAR(seenSin({0.5f, 0, 0}, 1.0f), 0.5f / std::sqrt(1.25f), 1e-6f);
}

TEST(ReceiverRule, ABodyThatItsSphereFitsDoesNotDarkenItself) {
  for (const float gap : {0.0f, 0.01f, 0.05f}) {  // the sphere is that much larger than the ball
    EXPECT_LT(seenSin({0, -1.0f, 0}, 1.0f + gap), 0.16f);
  }
}

TEST(ReceiverRule, WhatBulgesALittleOutOfAWallDoesNotDarkenIt) {
  for (float x = 0.0f; x < 3.0f; x += 0.05f) EXPECT_EQ(seenSin({x, -0.85f, 0}, 1.0f), 0.0f);  // by 0.15 of 2
  EXPECT_GT(seenSin({1.5f, -0.5f, 0}, 1.0f), 0.0f);
  // A ball sunk to its middle, or less, counts in full.
  EXPECT_NEAR(seenSin({3, -0.2f, 0}, 1.0f), 0.4f / std::sqrt(9.16f), 1e-6f);
}

TEST(ReceiverRule, ASphereThatStandsOutOfAPlateByHalfDoesNotDarkenIt) {
  for (float x = 0.0f; x < 3.0f; x += 0.05f) EXPECT_EQ(seenSin({x, 0, 0}, 1.0f, 0.5f), 0.0f);
  // What it stands on is darkened as ever; of a sphere that its surface hardly touches, half counts at least.
  EXPECT_EQ(seenSin({0.5f, 0.8f, 0}, 1.0f, 0.5f), seenSin({0.5f, 0.8f, 0}, 1.0f));
  EXPECT_EQ(seenSin({3, 0.2f, 0}, 1.0f, 1.0f), seenSin({3, 0.2f, 0}, 1.0f, 0.5f));
}

TEST(ReceiverRule, IsContinuous) {
  sampling::Rng random(8);
  float steepest = 0.0f;
  for (int path = 0; path < 300; ++path) {
    const glm::vec3 from = (random.next3() - 0.5f) * 6.0f, to = (random.next3() - 0.5f) * 6.0f;
    constexpr int kSteps = 4000;
    float before = -1.0f;
    for (int i = 0; i <= kSteps; ++i) {
      const float now = seenSin(glm::mix(from, to, float(i) / kSteps), 1.0f, float(path) / 300.0f);
      EXPECT_TRUE(now >= 0.0f && now <= 1.0f);
      if (before >= 0.0f) steepest = std::max(steepest, std::abs(now - before));
      before = now;
    }
  }
  EXPECT_LT(steepest,
            0.06f);  // steps of 0.0015 r; steepest where the sphere sinks below the plane, as a square root
}

TEST(ReceiverRule, DirectionsAreUnitAndAboveThePlane) {
  sampling::Rng random(9);
  for (int i = 0; i < 2000; ++i) {
    const SeenSphere seen =
        seenSphere(glm::vec3(0.0f), kUp, (random.next3() - 0.5f) * 4.0f, 0.2f + random.next());
    EXPECT_NEAR(glm::length(seen.direction), 1.0f, 1e-5f);
    EXPECT_GE(seen.direction.y, -1e-6f);
  }
}

TEST(ReceiverRule, ShaderSaysTheSame) {
  sampling::Rng random(10);
  for (int i = 0; i < 5000; ++i) {
    const glm::vec3 receiver = random.next3(), normal = sampling::uniformSphere(random.next2());
    const glm::vec3 center = receiver + (random.next3() - 0.5f) * 4.0f;
    const float radius = 1.2f * random.next(), bulge = random.next();
    const SeenSphere want = seenSphere(receiver, normal, center, radius, bulge);
    const glsl::SeenSphere got = glsl::seenSphere(receiver, normal, center, radius, bulge);
    EXPECT_NEAR(got.sin_half_angle, want.sin_half_angle, 1e-6f);
    EXPECT_LT(glm::distance(got.direction, want.direction), 1e-5f);
  }
}

}  // namespace
}  // namespace gloam::spheres
