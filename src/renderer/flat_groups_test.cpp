// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/flat_groups.h"

#include <gtest/gtest.h>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

/// Points of a floor of 4 x 4 m about the origin; `meets` says what rays from there do.
template <typename Meets>
std::vector<FlatPoint> floorPoints(Meets&& meets) {
  std::vector<FlatPoint> points;
  for (int z = 0; z < 60; ++z) {
    for (int x = 0; x < 60; ++x) {
      const glm::vec3 place((x + 0.5f) / 15.0f - 2.0f, 0, (z + 0.5f) / 15.0f - 2.0f);
      points.push_back({place, {0, 1, 0}, glm::vec3(0.5f), glm::vec3(0.0f), 1.0f / 225.0f, meets(place)});
    }
  }
  return points;
}

float areaOf(const std::vector<FlatGroup>& groups) {
  float area = 0.0f;
  for (const FlatGroup& group : groups) area += group.area;
  return area;
}

TEST(FlatGroups, EvenGroundIsCutIntoSquares) {
  const auto groups =
      groupedByLight({floorPoints([](const glm::vec3&) { return 0.5f; })}, {glm::mat3(1.0f)}, 16).at(0);
  ASSERT_EQ(groups.size(), 16u);
  EXPECT_NEAR(areaOf(groups), 16.0f, 1e-3f);
  for (const FlatGroup& group : groups) {
    EXPECT_EQ(group.axis, 1);
    EXPECT_NEAR(group.high.x - group.low.x, 1.0f, 0.1f);
    EXPECT_NEAR(group.high.z - group.low.z, 1.0f, 0.1f);
  }
}

TEST(FlatGroups, AnEdgeOfShadeIsCutAlong) {
  const auto shade = [](const glm::vec3& p) { return p.x < 0.7f ? 1.0f : 0.2f; };
  const auto groups = groupedByLight({floorPoints(shade)}, {glm::mat3(1.0f)}, 8).at(0);
  EXPECT_EQ(groups.size(), 8u);
  for (const FlatGroup& group : groups)
    EXPECT_TRUE(group.high.x < 0.7f || group.low.x > 0.7f) << group.low.x << " " << group.high.x;
}

TEST(FlatGroups, WhatSendsToNothingStaysCoarse) {
  std::vector<std::vector<FlatPoint>> points{floorPoints([](const glm::vec3&) { return 0.5f; }),
                                             floorPoints([](const glm::vec3&) { return 0.0f; })};
  const auto groups = groupedByLight(points, {glm::mat3(1.0f), glm::mat3(1.0f)}, 20);
  EXPECT_GT(groups[0].size(), 3 * groups[1].size());
  EXPECT_NEAR(areaOf(groups[1]), 16.0f, 1e-3f);
}

TEST(FlatGroups, RaysMeetWhatStandsOverThem) {
  SceneBuilder builder("roof");
  builder.place("roof", shapes::ground(20, 20, 1, 1), builder.diffuse("grey", glm::vec3(0.5f)), {0, 0.1f, 0});
  const Scene scene = builder.finish();
  std::vector<std::vector<FlatPoint>> points{floorPoints([](const glm::vec3&) { return 0.5f; })};
  const PosedScene posed = pose(scene, 0.0f);
  meetSurfaces(scene, posed, {&posed.instances[0]}, points);
  for (const FlatPoint& point : points[0]) EXPECT_GT(point.meets, 0.7f);
  for (FlatPoint& point : points[0]) point.normal = {0, -1, 0};
  meetSurfaces(scene, posed, {&posed.instances[0]}, points);
  for (const FlatPoint& point : points[0]) EXPECT_EQ(point.meets, 0.0f);
}

TEST(FlatGroups, PointsOfRoomsAreEnclosedByWhatIsFlatAlone) {
  SceneBuilder builder("room");
  const int grey = builder.diffuse("grey", glm::vec3(0.5f));
  builder.place("room", shapes::box({-3, -3, -3}, {3, 3, 3}, 1), grey);
  const Scene scene = builder.finish();
  const PosedScene posed = pose(scene, 0.0f);
  std::vector<std::vector<FlatPoint>> points{floorPoints([](const glm::vec3&) { return 0.5f; })};
  meetSurfaces(scene, posed, {&posed.instances[0]}, points);
  for (const FlatPoint& point : points[0]) EXPECT_GT(point.room, 1.0f);
  meetSurfaces(scene, posed, {}, points);
  for (const FlatPoint& point : points[0]) {
    EXPECT_EQ(point.room, 0.0f);
    EXPECT_EQ(point.meets, 1.0f);
  }
}

}  // namespace
}  // namespace gloam
