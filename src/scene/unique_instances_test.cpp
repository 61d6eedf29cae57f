// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <set>
#include <tuple>

#include "scene/builtin_scenes.h"
#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

// Where every vertex stands, instance by instance.
std::vector<glm::vec3> worldPositions(const Scene& scene) {
  std::vector<glm::vec3> all;
  for (const Instance& instance : pose(scene, 0.4f).instances) {
    if (instance.deformed()) {
      all.insert(all.end(), instance.deformed_positions.begin(), instance.deformed_positions.end());
      continue;
    }
    for (const glm::vec3& p : scene.meshes[std::size_t(instance.mesh)].positions) {
      all.emplace_back(instance.world_from_object * glm::vec4(p, 1.0f));
    }
  }
  std::sort(all.begin(), all.end(), [](const glm::vec3& a, const glm::vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
  return all;
}

void expectUnique(const Scene& scene) {
  const Scene unique = makeInstancesUnique(scene);
  std::set<int> seen;
  for (const Instance& instance : pose(unique, 0.0f).instances) {
    if (instance.deformed()) continue;
    EXPECT_TRUE(seen.insert(instance.mesh).second) << "a mesh stands twice";
  }
  for (const Node& node : unique.nodes) EXPECT_TRUE(node.instances.empty());
  const std::vector<glm::vec3> before = worldPositions(scene), after = worldPositions(unique);
  ASSERT_EQ(before.size(), after.size());
  float difference = 0.0f;
  for (std::size_t i = 0; i < before.size(); ++i)
    difference = std::max(difference, glm::length(before[i] - after[i]));
  EXPECT_LT(difference, 1e-5f);
}

TEST(UniqueInstances, EveryPlacedMeshIsItsOwnAndStandsWhereItStood) {
  for (const char* name : {"columns?detail=0.25", "walker?detail=0.25", "cornell?detail=0.25"}) {
    SCOPED_TRACE(name);
    expectUnique(makeBuiltinScene(name));
  }
}

TEST(UniqueInstances, SharedMeshesOnTurnedAndShearedNodes) {
  SceneBuilder builder("shared");
  const int mesh =
      builder.mesh("ball", shapes::icosphere(0.3f, 2), builder.diffuse("white", glm::vec3(1.0f)));
  const int first = builder.node("first", kNone, {1, 0, 0}),
            second = builder.node("second", first, {0, 1, 0});
  builder.at(first).meshes = {mesh};
  builder.at(first).rotation = glm::angleAxis(0.7f, glm::vec3(0, 0, 1));
  builder.at(second).meshes = {mesh, mesh};
  glm::mat4 shear(1.0f);
  shear[2].y = 0.4f;
  builder.at(second).instances = {shear, glm::scale(glm::mat4(1.0f), {-1, 2, 1})};
  const int hidden = builder.node("hidden");
  builder.at(hidden).meshes = {mesh};
  Scene scene = builder.finish();
  scene.roots = {first};
  expectUnique(scene);
  EXPECT_EQ(makeInstancesUnique(scene).meshes.size(), 5u);  // the hidden one is left out
}

TEST(UniqueInstances, MorphedMeshesStaySharedAndKeepMoving) {
  SceneBuilder builder("morph");
  Mesh ball = shapes::icosphere(0.3f, 2);
  MorphTarget target;
  target.positions.assign(ball.vertexCount(), {0, 1, 0});
  ball.morph_targets = {target};
  const int mesh = builder.mesh("ball", ball, builder.diffuse("white", glm::vec3(1.0f)));
  const int node = builder.node("balls");
  builder.at(node).meshes = {mesh};
  builder.at(node).morph_weights = {0.0f};
  builder.at(node).instances = {glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), {3, 0, 0})};
  AnimationChannel& channel =
      builder.channel(node, AnimationChannel::Path::kWeights, AnimationChannel::Interpolation::kLinear);
  channel.components = 1;
  channel.times_s = {0, 1};
  channel.values = {0, 1};
  const Scene scene = builder.finish();
  expectUnique(scene);
  EXPECT_EQ(makeInstancesUnique(scene).meshes.size(), 1u);
}

}  // namespace
}  // namespace gloam
