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
