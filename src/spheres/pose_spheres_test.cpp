// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Spheres go with their objects (SS-2).
#include <gloam/spheres.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "spheres/occupancy.h"
#include "spheres/test_scenes.h"

namespace gloam::spheres {
namespace {

double coverageOf(const std::vector<glm::vec3>& points, const std::vector<PosedSphere>& spheres) {
  std::size_t inside = 0;
  for (const glm::vec3& p : points) {
    inside +=
        std::ranges::any_of(
            spheres, [&](const PosedSphere& s) { return glm::distance(p, s.center) <= s.radius * 1.00001f; })
            ? 1
            : 0;
  }
  return double(inside) / double(points.size());
}

TEST(PoseSpheres, RigidObjectsByTheirMatrix) {
  Scene scene = sceneOf(shapes::torus(1.0f, 0.35f, 32, 16));
  const SceneSpheres spheres = bakeSpheres(scene, quick(6));
  scene.nodes[0].translation = {1, 2, 3};
  scene.nodes[0].rotation = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 2, 3)));
  scene.nodes[0].scale = {2, 2, 2};
  const std::vector<PosedSphere> posed = poseSpheres(spheres, scene, pose(scene, 0.0f));
  ASSERT_EQ(posed.size(), spheres.sets[0].spheres.size());
  for (const PosedSphere& p : posed) {
    const Sphere& s = spheres.sets[0].spheres[std::size_t(p.sphere)];
    const glm::vec3 want = scene.nodes[0].rotation * (2.0f * s.center) + glm::vec3(1, 2, 3);
    EXPECT_LT(glm::distance(p.center, want), 1e-5f);
    EXPECT_NEAR(p.radius, 2.0f * s.radius, 1e-5f);
  }
}

TEST(PoseSpheres, GoOnBoundingWhatIsStretchedUnevenly) {
  Scene scene = sceneOf(shapes::torus(1.0f, 0.35f, 32, 16));
  const SceneSpheres spheres = bakeSpheres(scene, quick(6));
  scene.nodes[0].scale = {3, 1, 0.5f};
  std::vector<glm::vec3> points;
  for (const glm::vec3& p : scene.meshes[0].positions) points.push_back(p * scene.nodes[0].scale);
  EXPECT_EQ(coverageOf(points, poseSpheres(spheres, scene, pose(scene, 0.0f))), 1.0);
  // Baked as it is stretched they fit better.
  const std::vector<PosedSphere> loose = poseSpheres(spheres, scene, pose(scene, 0.0f));
  const SceneSpheres again = bakeSpheres(scene, quick(6));
  const std::vector<PosedSphere> tight = poseSpheres(again, scene, pose(scene, 0.0f));
  EXPECT_EQ(coverageOf(points, tight), 1.0);
  double loose_volume = 0.0, tight_volume = 0.0;
  for (const PosedSphere& s : loose) loose_volume += double(ballVolume(s.radius));
  for (const PosedSphere& s : tight) tight_volume += double(ballVolume(s.radius));
  EXPECT_LT(tight_volume, 0.5 * loose_volume);
}

TEST(PoseSpheres, InstancesEachGetTheirOwn) {
  Scene scene = sceneOf(shapes::icosphere(1.0f, 8));
  scene.nodes[0].instances = {glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), {5, 0, 0})};
  const SceneSpheres spheres = bakeSpheres(scene, quick(2));
  ASSERT_EQ(spheres.sets.size(), 1u);
  const std::vector<PosedSphere> posed = poseSpheres(spheres, scene, pose(scene, 0.0f));
  ASSERT_EQ(posed.size(), 2u * spheres.sets[0].spheres.size());
  EXPECT_NEAR(posed.back().center.x - posed.front().center.x, 5.0f, 1e-4f);
  EXPECT_NE(posed.back().instance, posed.front().instance);
}

/// A bar along Y, its upper half on a joint of its own.
Scene jointedBar() {
  SceneBuilder builder("bar");
  const int white = builder.diffuse("white", glm::vec3(0.5f));
  const int lower = builder.node("lower"), upper = builder.node("upper", lower, {0, 1, 0});
  Mesh mesh = shapes::box({-0.2f, 0, -0.2f}, {0.2f, 2, 0.2f}, 0.1f);
  mesh.influences = 4;
  for (const glm::vec3& p : mesh.positions) {
    const float w = glm::smoothstep(0.8f, 1.2f, p.y);
    mesh.joints.insert(mesh.joints.end(), {0, 1, 0, 0});
    mesh.weights.insert(mesh.weights.end(), {1.0f - w, w, 0.0f, 0.0f});
  }
  const int body = builder.place("bar", std::move(mesh), white);
  builder.at(body).skin =
      builder.skin({lower, upper}, {glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), {0, -1, 0})});
  return builder.finish();
}

TEST(PoseSpheres, SkinsFollowTheirBones) {
  Scene scene = jointedBar();
  const SceneSpheres spheres = bakeSpheres(scene, quick(10));
  ASSERT_TRUE(spheres.sets[0].deforms);
  // At rest: where they were fitted.
  const PosedScene rest = pose(scene, 0.0f);
  for (const PosedSphere& p : poseSpheres(spheres, scene, rest)) {
    const Sphere& s = spheres.sets[0].spheres[std::size_t(p.sphere)];
    EXPECT_LT(glm::distance(p.center, s.center), 1e-4f);
    EXPECT_NEAR(p.radius, s.radius, 1e-4f);
  }
  // Bent by a right angle, and walked away: the ends go exactly with their bones.
  const glm::quat bend = glm::angleAxis(1.5707963f, glm::vec3(0, 0, 1));
  scene.nodes[1].rotation = bend;
  scene.nodes[0].translation = {3, 0, 0};
  const PosedScene bent = pose(scene, 0.0f);
  const std::vector<PosedSphere> posed = poseSpheres(spheres, scene, bent);
  int whole = 0;
  for (const PosedSphere& p : posed) {
    const Sphere& s = spheres.sets[0].spheres[std::size_t(p.sphere)];
    if (s.center.y - s.radius > 1.2f) {
      EXPECT_LT(glm::distance(p.center, bend * (s.center - glm::vec3(0, 1, 0)) + glm::vec3(3, 1, 0)), 2e-3f);
      EXPECT_NEAR(p.radius, s.radius, 2e-3f);
      ++whole;
    }
    if (s.center.y + s.radius < 0.8f) {
      EXPECT_LT(glm::distance(p.center, s.center + glm::vec3(3, 0, 0)), 1e-4f);
    }
    EXPECT_LE(p.radius, 1.31f * s.radius);
  }
  EXPECT_GT(whole, 0);
  EXPECT_GT(coverageOf(bent.instances[0].deformed_positions, posed), 0.98);
}

TEST(PoseSpheres, MorphsAreFollowedWithoutAJump) {
  Scene scene = sceneOf(shapes::icosphere(1.0f, 10));
  MorphTarget target;
  for (const glm::vec3& p : scene.meshes[0].positions)
    target.positions.push_back(p + glm::vec3(0, 4, 0));  // twice as large, 4 up
  scene.meshes[0].morph_targets = {target};
  const SceneSpheres spheres = bakeSpheres(scene, quick(1));
  glm::vec3 center(0.0f);
  float radius = 0.0f;
  for (int step = 0; step <= 64; ++step) {
    const float weight = float(step) / 64.0f;
    scene.nodes[0].morph_weights = {weight};
    const PosedSphere p = poseSpheres(spheres, scene, pose(scene, 0.0f)).at(0);
    EXPECT_NEAR(p.center.y, 4.0f * weight, 0.02f * (1.0f + weight));
    EXPECT_NEAR(p.radius, 1.0f + weight, 0.03f);
    if (step > 0) {
      EXPECT_LT(glm::distance(p.center, center) + std::abs(p.radius - radius), 0.12f);
    }
    center = p.center, radius = p.radius;
  }
}

// A skinned or morphed sheet: neither spheres nor anchors, fresh from the search as read from a file.
TEST(PoseSpheres, WhatDeformsAndOnlyReceivesIsPosed) {
  const std::vector<float> cells = shapes::steps(4);
  Scene scene = sceneOf(shapes::patch({-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, cells, cells));
  MorphTarget target;
  for (const glm::vec3& p : scene.meshes[0].positions) target.positions.push_back(glm::vec3(0, p.x * p.x, 0));
  scene.meshes[0].morph_targets = {target};
  scene.nodes[0].morph_weights = {0.5f};
  const SceneSpheres spheres = bakeSpheres(scene, quick(4));
  ASSERT_TRUE(spheres.sets[0].deforms);
  ASSERT_FALSE(spheres.sets[0].receive_only.empty());
  EXPECT_TRUE(poseSpheres(spheres, scene, pose(scene, 0.0f)).empty());
}

TEST(PoseSpheres, TheWalkerStaysCovered) {
  const Scene scene = loadScene("builtin:walker?detail=0.25");
  const SceneSpheres spheres = bakeSpheres(scene, quick(22, 0.02f));
  const auto figure = std::ranges::find_if(spheres.sets, [](const SphereSet& set) { return set.deforms; });
  ASSERT_NE(figure, spheres.sets.end());
  EXPECT_GT(figure->spheres.size(), 10u);
  for (const float time : {0.0f, 0.4f, 1.1f, 2.7f}) {
    const PosedScene posed = pose(scene, time);
    const std::vector<PosedSphere> placed = poseSpheres(spheres, scene, posed);
    for (const Instance& instance : posed.instances) {
      if (!instance.deformed()) continue;
      EXPECT_GT(coverageOf(instance.deformed_positions, placed), 0.97) << time;
    }
  }
}

/// Two bars close beside each other that swing apart.
Scene legs() {
  SceneBuilder builder("legs");
  const int white = builder.diffuse("white", glm::vec3(0.5f));
  const int left = builder.node("left"), right = builder.node("right");
  Mesh mesh = shapes::box({-0.22f, -2, -0.1f}, {-0.02f, 0, 0.1f}, 0.05f);
  shapes::append(mesh, shapes::box({0.02f, -2, -0.1f}, {0.22f, 0, 0.1f}, 0.05f));
  mesh.influences = 4;
  for (const glm::vec3& p : mesh.positions) {
    mesh.joints.insert(mesh.joints.end(), {std::uint16_t(p.x > 0.0f ? 1 : 0), 0, 0, 0});
    mesh.weights.insert(mesh.weights.end(), {1, 0, 0, 0});
  }
  const int body = builder.place("legs", std::move(mesh), white);
  builder.at(body).skin = builder.skin({left, right}, {glm::mat4(1.0f), glm::mat4(1.0f)});
  for (const int node : {left, right}) {
    auto& channel =
        builder.channel(node, AnimationChannel::Path::kRotation, AnimationChannel::Interpolation::kLinear);
    const float angle = node == left ? 0.7f : -0.7f;
    addKey(channel, 0.0f, glm::quat(1, 0, 0, 0));
    addKey(channel, 1.0f, glm::angleAxis(angle, glm::vec3(1, 0, 0)));
  }
  return builder.finish();
}

TEST(PoseSpheres, NoSphereHoldsWhatMovesApart) {
  const Scene scene = legs();
  const SceneSpheres spheres = bakeSpheres(scene, quick(12, 0.15f));
  int astride = 0;
  for (const Sphere& s : spheres.sets[0].spheres) {
    if (s.center.y > -1.0f) continue;  // near the hinge they stay together
    const float reach = std::sqrt(std::max(0.0f, s.radius * s.radius - s.center.z * s.center.z));
    const bool whole_left = s.center.x - reach<-0.2f, whole_right = s.center.x + reach> 0.2f;
    astride += whole_left && whole_right ? 1 : 0;
  }
  EXPECT_EQ(astride, 0);
  const PosedScene apart = pose(scene, 1.0f);
  EXPECT_GT(coverageOf(apart.instances[0].deformed_positions, poseSpheres(spheres, scene, apart)), 0.97);
}

TEST(PoseSpheres, RefusesTheSetsOfAnotherScene) {
  const Scene one = sceneOf(shapes::icosphere(1.0f, 4));
  SceneSpheres spheres = bakeSpheres(one, quick(1));
  spheres.sets[0].nodes = {5};
  EXPECT_THROW(poseSpheres(spheres, one, pose(one, 0.0f)), Error);
}

}  // namespace
}  // namespace gloam::spheres
