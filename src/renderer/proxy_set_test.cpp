// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/proxy_set.h"

#include <gloam/renderer.h>
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "golden.h"
#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

/// One object of two balls, a red one and a blue one, and a set of a sphere each.
Scene twoBalls() {
  SceneBuilder builder("balls");
  const int red = builder.mesh("red", shapes::moved(shapes::icosphere(1.0f, 4), {-2, 0, 0}),
                               builder.diffuse("red", {0.8f, 0.1f, 0.1f}));
  const int blue = builder.mesh("blue", shapes::moved(shapes::icosphere(1.0f, 4), {2, 0, 0}),
                                builder.diffuse("blue", {0.1f, 0.1f, 0.8f}));
  const int node = builder.node("object", kNone, {0, 5, 0});
  builder.at(node).meshes = {red, blue};
  builder.camera({0, 5, 10}, {0, 5, 0}, 40);
  builder.sky("uniform");
  return builder.finish();
}

SceneSpheres spheresOf() {
  SceneSpheres spheres;
  SphereSet set;
  set.name = "object", set.meshes = {0, 1}, set.nodes = {0};
  set.spheres = {{{-2, 0, 0}, 1.0f}, {{2, 0, 0}, 1.0f}};
  spheres.sets.push_back(set);
  return spheres;
}

TEST(ProxySet, SpheresHaveTheColourOfTheSurfaceNearThem) {
  const Scene scene = twoBalls();
  const std::vector<frame::Proxy> proxies = ProxySet(scene, spheresOf()).posed(pose(scene, 0.0f));
  ASSERT_EQ(proxies.size(), 2u);
  EXPECT_NEAR(proxies[0].center.y, 5.0f, 1e-5f);
  EXPECT_NEAR(proxies[0].albedo.x, 0.8f, 1e-3f);
  EXPECT_NEAR(proxies[0].albedo.z, 0.1f, 1e-3f);
  EXPECT_NEAR(proxies[1].albedo.z, 0.8f, 1e-3f);
}

TEST(ProxySet, SetsOfAnotherSceneAreRefused) {
  const Scene scene = twoBalls();
  SceneSpheres spheres = spheresOf();
  spheres.sets[0].meshes = {0, 7};
  EXPECT_THROW(ProxySet(scene, spheres), Error);
}

TEST(ProxySet, RendererAsksForSpheres) {
  const Scene scene = twoBalls();
  Renderer renderer("llvmpipe");
  EXPECT_THROW(renderer.setSpheres(scene, spheresOf()), Error);
  renderer.setScene(scene);
  const PosedScene posed = pose(scene, 0.0f);
  const RenderOptions options{.width = 32, .height = 32, .technique = "proxies"};
  EXPECT_THROW(renderer.render(posed, posed.cameras[0], options), Error);
  renderer.setSpheres(scene, spheresOf());
  const RenderedFrame frame = renderer.render(posed, posed.cameras[0], options);
  EXPECT_EQ(frame.layers.width, 32);
}

// Two balls on the ground under a low sun: soft shadows that touch them, red and blue light on the ground.
TEST(ProxySet, GoldenPicture) {
  Scene scene = twoBalls();
  scene.nodes[0].translation = {0, 1, 0};
  addGround(scene, glm::vec3(0.6f));
  scene.environment = loadEnvironment("sky:preetham?elevation=40&azimuth=100");
  PosedCamera camera = pose(scene, 0.0f).cameras[0];
  camera.world_from_view = glm::inverse(
      glm::lookAt(glm::vec3(1.5f, 3.5f, 7.0f), glm::vec3(0.0f, 0.6f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f)));
  Renderer renderer("llvmpipe");
  renderer.setScene(scene);
  renderer.setSpheres(scene, spheresOf());
  const RenderedFrame frame =
      renderer.render(pose(scene, 0.0f), camera, {.width = 128, .height = 128, .technique = "proxies"});
  EXPECT_EQ(test::compareWithGolden(toDisplay(frame.layers, {.exposure_stops = -1.0f}), "proxies_balls",
                                    {.max_difference = 4}),
            "");
}

}  // namespace
}  // namespace gloam
