// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/spheres_scene.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "renderer/proxy_set.h"
#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

TEST(SpheresScene, CastersGiveWayToTheirSpheres) {
  SceneBuilder builder("stage");
  builder.place("ground", shapes::ground(4, 4, 2, 2), builder.diffuse("grey", glm::vec3(0.5f)));
  builder.place("ball", shapes::icosphere(0.5f, 16), builder.diffuse("red", {0.7f, 0.1f, 0.1f}), {1, 2, 3});
  builder.sky("uniform");
  const Scene scene = builder.finish();
  const SceneSpheres spheres = bakeSpheres(scene, {.count = 1, .samples = 1000, .effort = 0.05f});
  const PosedScene posed = pose(scene, 0.0f);
  const Scene replaced = spheresInPlace(scene, spheres, posed);
  const PosedScene seen = pose(replaced, 0.0f);
  ASSERT_EQ(seen.instances.size(), 2u);
  EXPECT_EQ(replaced.meshes[std::size_t(seen.instances[0].mesh)].name, scene.meshes[0].name)
      << "ground stays";
  const Mesh& ball = replaced.meshes[std::size_t(seen.instances[1].mesh)];
  EXPECT_NEAR(replaced.materials[std::size_t(ball.material)].base_color.x, 0.7f, 1e-3f);
  const frame::Proxy proxy = ProxySet(scene, spheres).posed(posed).at(0);
  for (const glm::vec3& p : ball.positions) {
    ASSERT_NEAR(glm::distance(p, proxy.center), proxy.radius, 1e-4f);
    ASSERT_NEAR(glm::distance(p, glm::vec3(1, 2, 3)), 0.5f, 0.02f);
  }
  EXPECT_EQ(replaced.environment.name, scene.environment.name);
}

}  // namespace
}  // namespace gloam
