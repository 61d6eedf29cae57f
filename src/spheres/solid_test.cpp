// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Inside and outside, volumes, what kind of body a mesh is.
#include "spheres/solid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spheres/test_scenes.h"

namespace gloam::spheres {
namespace {

constexpr float kPi = sampling::kPi;

TEST(Winding, IsOneInsideAndZeroOutside) {
  const Soup soup = soupOf(shapes::torus(1.0f, 0.4f, 64, 32));
  const WindingTree winding(soup);
  sampling::Rng random(3);
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 p = (random.next3() - 0.5f) * 3.2f;
    const float ring = std::sqrt(p.x * p.x + p.z * p.z) - 1.0f;
    const float distance = std::sqrt(ring * ring + p.y * p.y) - 0.4f;
    if (std::abs(distance) < 0.01f) continue;
    EXPECT_NEAR(winding.at(p), distance < 0.0f ? 1.0f : 0.0f, 0.1f) << p.x << ' ' << p.y << ' ' << p.z;
  }
}

TEST(Winding, EqualsTheSlowSumOverTriangles) {
  const Soup soup = soupOf(shapes::bowl(1.0f, 0.6f, 12));
  const WindingTree winding(soup);
  sampling::Rng random(4);
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 p = (random.next3() - 0.5f) * 4.0f;
    double sum = 0.0;
    for (std::size_t t = 0; t < soup.triangleCount(); ++t) {
      sum += double(triangleSolidAngle(soup.corner(t, 0), soup.corner(t, 1), soup.corner(t, 2), p));
    }
    EXPECT_NEAR(double(winding.at(p)), sum / (4.0 * double(kPi)), 0.05);
  }
}

TEST(Winding, OfNothingIsZero) {
  EXPECT_EQ(WindingTree(Soup{}).at(glm::vec3(0.0f)), 0.0f);
}

TEST(Occupancy, VolumeOfABallOutsideAnother) {
  const Soup soup = soupOf(shapes::icosphere(1.0f, 24));
  const WindingTree winding(soup);
  const Occupancy occupancy(soup, winding, 64, true, false);
  EXPECT_NEAR(occupancy.volume(), 4.0f / 3.0f * kPi, 0.01f * 4.0f / 3.0f * kPi);
  // Two balls of radii 1 and r at distance d: the lens between them in closed form.
  for (const auto& [d, r] :
       std::vector<std::pair<float, float>>{{0.9f, 0.5f}, {0.4f, 0.9f}, {1.3f, 0.7f}, {0.0f, 0.6f}}) {
    float lens = ballVolume(std::min(r, 1.0f));
    if (d > std::abs(1.0f - r)) {
      const float q = 1.0f + r - d;
      lens = kPi * q * q * (d * d + 2.0f * d * (r + 1.0f) - 3.0f * (r - 1.0f) * (r - 1.0f)) / (12.0f * d);
    }
    for (const glm::vec3& way :
         {glm::vec3(1, 0, 0), glm::vec3(0, 0, 1), glm::normalize(glm::vec3(1, 2, 3))}) {
      EXPECT_NEAR(occupancy.outsideVolume(way * d, r), ballVolume(r) - lens, 0.015f * ballVolume(r))
          << d << ' ' << r;
    }
  }
  EXPECT_NEAR(occupancy.outsideVolume({5, 5, 5}, 0.5f), ballVolume(0.5f), 0.015f * ballVolume(0.5f));
}

TEST(Occupancy, ManyTrianglesAndFewSayTheSame) {
  const Soup fine = soupOf(shapes::box({-1, -0.5f, -0.25f}, {1, 0.5f, 0.25f}, 0.05f));
  const Soup coarse = soupOf(shapes::box({-1, -0.5f, -0.25f}, {1, 0.5f, 0.25f}, 10.0f));
  ASSERT_EQ(coarse.triangleCount(), 12u);
  for (const Soup& soup : {fine, coarse}) {
    const Occupancy occupancy(soup, WindingTree(soup), 40, true, false);
    EXPECT_NEAR(occupancy.volume(), 1.0f, 0.03f);
  }
}

TEST(Solid, KnowsWhatItIs) {
  const Solid ball = makeSolid(soupOf(shapes::icosphere(3.0f, 8)));
  EXPECT_TRUE(ball.closed);
  EXPECT_FALSE(ball.inverted || ball.shell);
  EXPECT_GT(ball.flatness(), 0.95f);
  EXPECT_FLOAT_EQ(ball.scale, 6.0f);

  EXPECT_TRUE(makeSolid(soupOf(turnedInsideOut(shapes::icosphere(1.0f, 6)))).inverted);

  const Solid bowl = makeSolid(soupOf(shapes::bowl(1.0f, 0.5f, 8)));
  EXPECT_FALSE(bowl.closed);
  EXPECT_FALSE(bowl.shell);

  const Solid cross = makeSolid(soupOf(crossedSheets()));
  EXPECT_FALSE(cross.closed);
  EXPECT_TRUE(cross.shell);

  const Solid plate = makeSolid(
      soupOf(shapes::transformed(shapes::box({-1, -1, -0.02f}, {1, 1, 0.02f}, 0.1f),
                                 glm::mat4(glm::mat3(sampling::frame(glm::normalize(glm::vec3(1, 2, 3))))))));
  EXPECT_TRUE(plate.closed);
  EXPECT_GT(plate.flatness(), 0.0139f);  // along the diagonal of the square
  EXPECT_LT(plate.flatness(), 0.0201f);
}

TEST(Solid, BearsMeshesWithoutArea) {
  EXPECT_TRUE(makeSolid({}).degenerate());
  EXPECT_TRUE(makeSolid({{{1, 2, 3}}, {0, 0, 0}}).degenerate());
  EXPECT_TRUE(makeSolid({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 1, 2}}).degenerate());
  const Solid triangle = makeSolid({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}});
  EXPECT_FALSE(triangle.degenerate());
  EXPECT_NEAR(triangle.flatness(), 0.0f, 1e-5f);
}

TEST(Surface, SamplesLieOnItAndEvenly) {
  const Soup soup = soupOf(shapes::box({0, 0, 0}, {1, 2, 3}, 0.5f));
  const std::vector<glm::vec3> points = sampleSurface(soup, 22000, 5);
  int top = 0;
  for (const glm::vec3& p : points) top += p.y > 1.9999f ? 1 : 0;
  EXPECT_NEAR(double(top) / 22000.0, 3.0 / 22.0, 0.002);
}

TEST(Surface, UncoveredPointsAreFoundAndGrownOver) {
  const Soup soup = soupOf(shapes::box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, 0.25f));
  std::vector<Ball> balls{{{0, 0, 0}, 0.6f}};
  const std::vector<glm::vec3> missed = uncoveredPoints(soup, balls, 0.01f);
  EXPECT_GE(missed.size(), 8u);
  for (const glm::vec3& p : missed) EXPECT_FALSE(holds(balls[0], p));
  growOver(soup, balls, 0.01f);
  EXPECT_TRUE(uncoveredPoints(soup, balls, 0.01f).empty());
  EXPECT_NEAR(balls[0].radius, std::sqrt(0.75f), 1e-4f);
}

TEST(Surface, NoGapStaysAlongTheSeamOfTwoBalls) {
  // Two balls that meet in the circle of a tube's surface, so that it lies in neither just there.
  const Soup tube = soupOf(shapes::cylinder(0.2f, 2.0f, 0.02f, 64, 8));
  std::vector<Ball> balls{{{0, 0.45f, 0}, 0.58f}, {{0, 1.55f, 0}, 0.58f}};
  EXPECT_LT(coveredShare(sampleSurface(tube, 50000, 1), balls), 0.9999);
  growOver(tube, balls, 0.001f);
  EXPECT_EQ(coveredShare(sampleSurface(tube, 200000, 1), balls), 1.0);
  EXPECT_LT(balls[0].radius + balls[1].radius, 1.2f);
}

}  // namespace
}  // namespace gloam::spheres
