// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The search: what it may never do.
#include "spheres/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spheres/search.h"
#include "spheres/test_scenes.h"

namespace gloam::spheres {
namespace {

struct Task {
  explicit Task(const Mesh& mesh) : solid(makeSolid(soupOf(mesh))) {
    for (const glm::vec3& p : sampleSurface(solid.soup, 1000, 2)) points.add(p);
  }
  Solid solid;
  FitPoints points;
};

void expectAllHeld(const FitPoints& points, const std::vector<Ball>& balls, const char* when) {
  for (std::size_t i = 0; i < points.count(); ++i) {
    ASSERT_TRUE(std::ranges::any_of(balls, [&](const Ball& b) { return holds(b, points.at(i)); }))
        << when << ' ' << i;
  }
}

TEST(Fit, NeverLetsGoOfAPointAndNeverGetsWorse) {
  const Task task(shapes::torus(1.0f, 0.3f, 48, 24));
  Fit fit(*task.solid.coarse, task.points, 7, 0);
  fit.startFromClusters(9);
  expectAllHeld(task.points, fit.balls(), "at first");
  double cost = fit.cost();
  for (int round = 0; round < 6; ++round) {
    fit.run(10, 0.05f, 0.0f);
    expectAllHeld(task.points, fit.balls(), "later");
    EXPECT_LE(fit.cost(), cost);
    cost = fit.cost();
  }
  double sum = 0.0;
  for (const Ball& ball : fit.balls())
    sum += double(task.solid.coarse->outsideVolume(ball.center, ball.radius));
  EXPECT_NEAR(sum, cost, 1e-6);
}

TEST(Fit, TakesOverBallsThatHoldTooLittle) {
  const Task task(shapes::icosphere(1.0f, 8));
  Fit fit(*task.solid.coarse, task.points, 7, 0);
  fit.startFrom({{{0.1f, 0.0f, 0.0f}, 0.2f}, {{-0.1f, 0.0f, 0.0f}, 0.0f}});
  expectAllHeld(task.points, fit.balls(), "after");
}

TEST(Fit, EndsAtItsBoundOfLooks) {
  const Task task(shapes::icosphere(1.0f, 12));
  Fit fit(*task.solid.coarse, task.points, 1, 0);
  fit.startFromClusters(200);
  const std::uint64_t before = fit.looks();
  fit.run(1, 0.0f, 0.0f);
  const std::uint64_t one = fit.looks() - before, bound = 20 * one;
  fit.run(1000000, 0.01f, 0.0f, bound);
  EXPECT_GT(fit.looks() - before, bound / 2);
  EXPECT_LT(fit.looks() - before, 8 * bound);  // a move more, which may be a long one
  expectAllHeld(task.points, fit.balls(), "after");
}

TEST(Fit, StopsWithinAMove) {
  const Task task(shapes::icosphere(1.0f, 12));
  int asked = 0;
  Fit fit(*task.solid.coarse, task.points, 1, 0, [&] { return ++asked > 250; });
  EXPECT_THROW(fit.startFromClusters(200), Interrupted);
  EXPECT_EQ(asked, 251);
}

/// Against all balls for each piece.
TEST(Surface, AmongManyBallsThePointsThatNoneHolds) {
  const Solid solid = makeSolid(soupOf(shapes::torus(1.0f, 0.3f, 24, 12)));
  sampling::Rng random(5, 1);
  std::vector<Ball> balls;
  for (const glm::vec3& p : sampleSurface(solid.soup, 300, 9)) {
    balls.push_back({p, random.next() < 0.2f ? 0.0f : 0.01f + 0.06f * random.next()});
  }
  const std::vector<glm::vec3> missed = uncoveredPoints(solid.soup, balls, 0.02f);
  EXPECT_GT(missed.size(), 10u);
  for (const glm::vec3& p : missed)
    EXPECT_FALSE(std::ranges::any_of(balls, [&](const Ball& b) { return holds(b, p); }));
  growOver(solid.soup, balls, 0.002f);
  EXPECT_TRUE(uncoveredPoints(solid.soup, balls, 0.002f).empty());
  EXPECT_EQ(coveredShare(sampleSurface(solid.soup, 20000, 3), balls), 1.0);
}

TEST(Fit, FindsTheBallRoundABall) {
  const Task task(shapes::icosphere(1.0f, 12));
  Fit fit(*task.solid.coarse, task.points, 1, 0);
  fit.startFromClusters(1);
  fit.run(1, 0.0f, 0.0f);
  EXPECT_NEAR(glm::length(fit.balls()[0].center), 0.0f, 0.01f);
  EXPECT_NEAR(fit.balls()[0].radius, 0.5f, 0.01f);
}

TEST(Fit, BearsMoreBallsThanPoints) {
  Task task(shapes::icosphere(1.0f, 4));
  FitPoints few;
  for (int i = 0; i < 5; ++i) few.add(task.points.at(std::size_t(i)));
  Fit fit(*task.solid.coarse, few, 1, 0);
  fit.startFromClusters(40);
  fit.run(20, 0.05f, 0.0f);
  expectAllHeld(few, fit.balls(), "after");
}

TEST(Measure, OverlapsCountOnceInTheUnion) {
  const Solid solid = makeSolid(soupOf(shapes::icosphere(1.0f, 24)));
  const Ball round{{0, 0, 0}, 0.5f}, far{{2, 0, 0}, 0.25f};
  const Measured one = measureBalls(solid, {round}, 1);
  EXPECT_NEAR(one.volume, double(ballVolume(0.5f)), 0.004);
  EXPECT_LT(one.outside_sum, 0.01);
  const Measured three = measureBalls(solid, {round, far, far}, 1);
  EXPECT_NEAR(three.outside_sum - one.outside_sum, 2.0 * double(ballVolume(0.25f)), 1e-4);
  EXPECT_NEAR(three.outside_union - one.outside_union, double(ballVolume(0.25f)), 1e-4);
  EXPECT_GT(three.coverage, 0.9999);
  EXPECT_NEAR(measureBalls(solid, {{{0.5f, 0, 0}, 0.5f}}, 1).coverage, 0.25, 0.003);  // a cap of height 1/2 R
}

}  // namespace
}  // namespace gloam::spheres
