// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/emission_set.h"

#include <gloam/renderer.h>
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "golden.h"
#include "renderer/flat_patches.h"
#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

Scene ballOverGround() {
  SceneBuilder builder("ball");
  builder.place("ball", shapes::icosphere(1.0f, 8), builder.diffuse("red", {0.8f, 0.1f, 0.1f}));
  builder.place("ground", shapes::ground(20, 10, 4, 4), builder.diffuse("grey", glm::vec3(0.5f)));
  return builder.finish();
}

SceneSpheres spheresOf(const Scene& scene) {
  SceneSpheres spheres;
  spheres.sets.resize(2);
  for (std::size_t s = 0; s < 2; ++s) {
    spheres.sets[s].meshes = scene.nodes[s].meshes;
    spheres.sets[s].nodes = {int(s)};
  }
  spheres.sets[0].spheres = {{{-0.2f, 0, 0}, 1.1f}, {{0.2f, 0, 0}, 1.1f}};
  spheres.sets[1].receive_only = "flat";
  return spheres;
}

TEST(EmissionSet, SamplesGoWithTheirObject) {
  Scene scene = ballOverGround();
  const SceneSpheres spheres = spheresOf(scene);
  const SceneEmission emission = sampleEmission(scene, spheres);
  const EmissionSet set(scene, spheres, emission, {{1.0f, 1.0f}, {}});
  const frame::Emission rest = set.posed(pose(scene, 0.0f), poseSpheres(spheres, scene, pose(scene, 0.0f)));
  // Moved, turned, twice as large.
  scene.nodes[0].translation = {3, 4, 5}, scene.nodes[0].scale = glm::vec3(2.0f);
  scene.nodes[0].rotation = glm::angleAxis(1.2f, glm::normalize(glm::vec3(1, 2, 3)));
  const PosedScene posed = pose(scene, 0.0f);
  const frame::Emission now = set.posed(posed, poseSpheres(spheres, scene, posed));
  ASSERT_EQ(now.points.size(), 2u * kEmissionDirections);
  const glm::mat3 turn = glm::mat3_cast(scene.nodes[0].rotation);
  for (std::size_t i = 0; i < now.points.size(); ++i) {
    ASSERT_EQ(now.points[i].sends, rest.points[i].sends);
    if (now.points[i].sends == 0.0f) continue;
    ASSERT_LT(
        glm::distance(now.points[i].position, glm::vec3(3, 4, 5) + 2.0f * (turn * rest.points[i].position)),
        1e-4f);
    ASSERT_LT(glm::distance(now.points[i].normal, turn * rest.points[i].normal), 1e-4f);
  }
  EXPECT_LT(glm::distance(now.proxies[1].world_from_shape[0], turn[0]), 1e-5f);
  EXPECT_EQ(now.meets[0], 3u);  // both, and itself
  EXPECT_EQ(now.proxies[1].first, 0);
  EXPECT_EQ(now.proxies[1].count, 2);
}

// A cylinder that bends: each sample is a point of the deformed surface, its normal unit and outward.
TEST(EmissionSet, SamplesGoWithSkins) {
  const Scene scene = loadScene("builtin:bend?angle=120&detail=0.4");
  SceneSpheres spheres;
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    if (scene.nodes[n].meshes.empty()) continue;
    SphereSet& set = spheres.sets.emplace_back();
    set.meshes = scene.nodes[n].meshes;
    set.nodes = {int(n)};
    if (scene.nodes[n].name != "cylinder") {
      set.receive_only = "flat";
      continue;
    }
    for (int i = 0; i < 6; ++i) set.spheres.push_back({{0.4f * float(i) - 1.0f, 0, 0}, 0.32f});
  }
  std::vector<std::vector<float>> shares;
  for (const SphereSet& set : spheres.sets) shares.emplace_back(set.spheres.size(), 1.0f);
  const EmissionSet set(scene, spheres, sampleEmission(scene, spheres), shares);
  const PosedScene bent = pose(scene, 2.0f);
  const Instance* skin = nullptr;
  for (const Instance& instance : bent.instances) {
    if (instance.deformed()) skin = &instance;
  }
  ASSERT_NE(skin, nullptr);
  const frame::Emission emission = set.posed(bent, poseSpheres(spheres, scene, bent));
  ASSERT_EQ(emission.points.size(), 6u * kEmissionDirections);
  int sending = 0;
  for (std::size_t i = 0; i < emission.points.size(); ++i) {
    const frame::EmissionPoint& point = emission.points[i];
    if (point.sends == 0.0f) continue;
    ++sending;
    float nearest = INFINITY;
    std::size_t at = 0;
    for (std::size_t v = 0; v < skin->deformed_positions.size(); ++v) {
      const float far = glm::distance(point.position, skin->deformed_positions[v]);
      if (far < nearest) nearest = far, at = v;
    }
    EXPECT_LT(nearest, 0.12f) << "it lies on the surface";
    EXPECT_NEAR(glm::length(point.normal), 1.0f, 1e-3f);
    EXPECT_GT(glm::dot(point.normal, skin->deformed_normals[at]), 0.3f);
  }
  EXPECT_GT(sending, 200);
}

// Twice as wide as high: samples lie on the stretched surface with the normals that it has there.
TEST(EmissionSet, SamplesGoWithANonUniformScale) {
  Scene scene = ballOverGround();
  const SceneSpheres spheres = spheresOf(scene);
  const SceneEmission emission = sampleEmission(scene, spheres);
  const EmissionSet set(scene, spheres, emission, {{1.0f, 1.0f}, {}});
  scene.nodes[0].scale = {2.0f, 1.0f, 1.0f};
  const PosedScene posed = pose(scene, 0.0f);
  const frame::Emission now = set.posed(posed, poseSpheres(spheres, scene, posed));
  for (const frame::EmissionPoint& point : now.points) {
    if (point.sends == 0.0f) continue;
    const glm::vec3 p = point.position * glm::vec3(0.5f, 1.0f, 1.0f);
    EXPECT_NEAR(glm::length(p), 1.0f, 0.03f);
    const glm::vec3 outward = glm::normalize(p * glm::vec3(0.5f, 1.0f, 1.0f));
    EXPECT_GT(glm::dot(point.normal, outward), 0.99f);
  }
}

// The upper and the lower side of a thin slab block once.
TEST(EmissionSet, ThinThingsBlockAsOneSide) {
  SceneBuilder builder("slab");
  builder.place("slab", shapes::box({-4, -0.05f, -4}, {4, 0.05f, 4}, 1.0f),
                builder.diffuse("grey", glm::vec3(0.5f)));
  const Scene scene = builder.finish();
  SceneSpheres spheres;
  spheres.sets.resize(1);
  spheres.sets[0].meshes = scene.nodes[0].meshes;
  spheres.sets[0].nodes = {0};
  spheres.sets[0].receive_only = "flat";
  const PosedScene posed = pose(scene, 0.0f);
  float area = 0.0f;
  for (const frame::Patch& patch : FlatPatches(scene, spheres, 0, kBlockingPatches, 0).blockers(posed)) {
    if (std::abs(patch.normal.y) > 0.9f) area += 4.0f * glm::length(glm::cross(patch.half_u, patch.half_v));
  }
  EXPECT_NEAR(area, 64.0f, 3.0f);
}

// Thirty slats, one behind another, block as about one.
TEST(EmissionSet, RowsOfStripsBlockWithinTheirBounds) {
  SceneBuilder builder("row");
  const Mesh slat = shapes::box({-0.5f, 0, -0.01f}, {0.5f, 0.1f, 0.01f}, 1.0f);
  Mesh row = slat;
  for (int i = 1; i < 30; ++i) shapes::append(row, shapes::moved(slat, {0, 0, 0.1f * float(i)}));
  builder.place("row", std::move(row), builder.diffuse("grey", glm::vec3(0.5f)));
  const Scene scene = builder.finish();
  SceneSpheres spheres;
  spheres.sets.resize(1);
  spheres.sets[0].meshes = scene.nodes[0].meshes;
  spheres.sets[0].nodes = {0};
  spheres.sets[0].receive_only = "flat";
  const PosedScene posed = pose(scene, 0.0f);
  for (const frame::Patch& patch : FlatPatches(scene, spheres, 0, kBlockingPatches, 0).blockers(posed)) {
    if (std::abs(patch.normal.z) < 0.9f) continue;
    const float half = std::max(glm::length(patch.half_u), glm::length(patch.half_v));
    EXPECT_LT(half, 1.6f * 0.5f);
  }
}

TEST(EmissionSet, GroundBecomesRectanglesOfItsArea) {
  const Scene scene = ballOverGround();
  const SceneSpheres spheres = spheresOf(scene);
  const EmissionSet set(scene, spheres, sampleEmission(scene, spheres), {{1.0f, 1.0f}, {}});
  const PosedScene posed = pose(scene, 0.0f);
  const frame::Emission emission = set.posed(posed, poseSpheres(spheres, scene, posed));
  for (const std::vector<frame::Patch>* patches : {&emission.sending_patches, &emission.blocking_patches}) {
    ASSERT_FALSE(patches->empty());
    float area = 0.0f;
    for (const frame::Patch& patch : *patches) {
      area += 4.0f * glm::length(glm::cross(patch.half_u, patch.half_v));
      EXPECT_GT(patch.normal.y, 0.999f);
      EXPECT_NEAR(patch.center.y, 0.0f, 1e-4f);
      EXPECT_NEAR(patch.albedo.x, 0.5f, 1e-3f);
    }
    EXPECT_NEAR(area, 200.0f, 4.0f);
  }
  EXPECT_GT(emission.sending_patches.size(), 80u);
  EXPECT_LE(emission.blocking_patches.size(), 12u);
}

TEST(EmissionSet, EmissionOfOthersIsRefused) {
  const Scene scene = ballOverGround();
  const SceneSpheres spheres = spheresOf(scene);
  SceneEmission emission = sampleEmission(scene, spheres);
  for (EmissionSample& sample : emission.sets[0].spheres[0].samples) sample.triangle = 1u << 30;
  EXPECT_THROW(EmissionSet(scene, spheres, emission, {{1.0f, 1.0f}, {}}), Error);
  emission.sets[0].spheres.pop_back();
  EXPECT_THROW(EmissionSet(scene, spheres, emission, {{1.0f, 1.0f}, {}}), Error);
}

// A red ball on the ground beside a white one, under a low sun: red on the white ball and on the ground, the ground's light below both.
TEST(EmissionSet, GoldenPicture) {
  SceneBuilder builder("balls");
  builder.place("red", shapes::moved(shapes::icosphere(1.0f, 12), {-1.1f, 1, 0}),
                builder.diffuse("red", {0.8f, 0.1f, 0.1f}));
  builder.place("white", shapes::moved(shapes::icosphere(1.0f, 12), {1.1f, 1, 0}),
                builder.diffuse("white", glm::vec3(0.8f)));
  builder.place("ground", shapes::ground(16, 16, 4, 4), builder.diffuse("grey", glm::vec3(0.5f)));
  builder.sky("preetham?elevation=40&azimuth=100");
  const Scene scene = builder.finish();
  SceneSpheres spheres;
  spheres.sets.resize(3);
  for (std::size_t s = 0; s < 3; ++s) {
    spheres.sets[s].meshes = scene.nodes[s].meshes;
    spheres.sets[s].nodes = {int(s)};
  }
  spheres.sets[0].spheres = {{{-1.1f, 1, 0}, 1.0f}};
  spheres.sets[1].spheres = {{{1.1f, 1, 0}, 1.0f}};
  spheres.sets[2].receive_only = "flat";
  PosedCamera camera;
  camera.camera.vertical_fov_rad = 0.7f;
  camera.world_from_view = glm::inverse(
      glm::lookAt(glm::vec3(1.5f, 3.5f, 7.0f), glm::vec3(0.0f, 0.8f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f)));
  Renderer renderer("llvmpipe");
  const SceneEmission emission = sampleEmission(scene, spheres);
  EXPECT_THROW(renderer.setEmission(scene, emission), Error);
  renderer.setScene(scene);
  renderer.setSpheres(scene, spheres);
  const RenderOptions options{.width = 128, .height = 128, .technique = "spherical_lights"};
  EXPECT_THROW(renderer.render(pose(scene, 0.0f), camera, options), Error);
  renderer.setEmission(scene, emission);
  const RenderedFrame frame = renderer.render(pose(scene, 0.0f), camera, options);
  EXPECT_EQ(test::compareWithGolden(toDisplay(frame.layers, {.exposure_stops = -1.0f}),
                                    "spherical_lights_balls", {.max_difference = 4}),
            "");
}

}  // namespace
}  // namespace gloam
