// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/flat_points.h"

#include <gtest/gtest.h>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

int glowing(SceneBuilder& builder) {
  const int material = builder.diffuse("glow", glm::vec3(0.0f));
  builder.material(material).emission = {1, 2, 3};
  return material;
}

/// Areas of the first thing that shine to +Y and to -Y.
glm::vec2 shining(const Scene& scene) {
  const PosedScene posed = pose(scene, 0.0f);
  glm::vec2 areas(0.0f);
  const std::vector<std::vector<FlatPoint>> points = shiningPoints(scene, posed, {&posed.instances[0]});
  for (const FlatPoint& point : points.at(0)) {
    EXPECT_EQ(point.emission, glm::vec3(1, 2, 3));
    if (point.normal.y > 0.5f) areas.x += point.area;
    if (point.normal.y < -0.5f) areas.y += point.area;
  }
  return areas;
}

TEST(FlatPoints, APaneShinesToBothSides) {
  SceneBuilder builder("pane");
  builder.place("pane", shapes::ground(2, 1, 1, 1), glowing(builder));
  const glm::vec2 areas = shining(builder.finish());
  EXPECT_NEAR(areas.x, 2.0f, 0.01f);
  EXPECT_NEAR(areas.y, 2.0f, 0.01f);
}

TEST(FlatPoints, APanelDoesNotShineIntoItsFrame) {
  SceneBuilder builder("panel");
  builder.place("pane", shapes::ground(2, 1, 1, 1), glowing(builder), {0, 0.02f, 0});
  builder.place("frame", shapes::box({-1.1f, -0.1f, -0.6f}, {1.1f, 0.0f, 0.6f}, 1.0f),
                builder.diffuse("grey", glm::vec3(0.5f)));
  const glm::vec2 areas = shining(builder.finish());
  EXPECT_NEAR(areas.x, 2.0f, 0.01f);
  EXPECT_EQ(areas.y, 0.0f);
}

TEST(FlatPoints, WhatIsClosedShinesOutward) {
  SceneBuilder builder("box");
  builder.place("box", shapes::box({-1, 0, -0.5f}, {1, 1, 0.5f}, 1.0f), glowing(builder));
  const glm::vec2 areas = shining(builder.finish());
  EXPECT_NEAR(areas.x, 2.0f, 0.02f);
  EXPECT_NEAR(areas.y, 2.0f, 0.02f);
}

TEST(FlatPoints, WhatIsDarkDoesNotShine) {
  SceneBuilder builder("dark");
  builder.place("pane", shapes::ground(2, 1, 1, 1), builder.diffuse("grey", glm::vec3(0.5f)));
  EXPECT_EQ(shining(builder.finish()), glm::vec2(0.0f));
}

}  // namespace
}  // namespace gloam
