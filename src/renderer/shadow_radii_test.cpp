// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/shadow_radii.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;

Scene sceneOf(Mesh mesh) {
  SceneBuilder builder("test");
  builder.place("thing", std::move(mesh), builder.diffuse("white", glm::vec3(0.5f)));
  return builder.finish();
}

SphereSet setOf(std::vector<Sphere> spheres) {
  SphereSet set;
  set.name = "thing", set.meshes = {0}, set.nodes = {0};
  set.spheres = std::move(spheres);
  return set;
}

Mesh turnedInsideOut(Mesh mesh) {
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
    std::swap(mesh.indices[t], mesh.indices[t + 1]);
  return mesh;
}

// A convex body's mean projected area is a quarter of its surface (Cauchy).
TEST(ShadowShares, SphereRoundACubeGetsTheCubesMeanShadow) {
  const Mesh cube = shapes::box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, 0.25f);
  const float want = std::sqrt(6.0f / 4.0f / kPi) / std::sqrt(0.75f);
  const SphereSet set = setOf({{glm::vec3(0.0f), std::sqrt(0.75f)}});
  EXPECT_NEAR(shadowShares(sceneOf(cube), set).at(0), want, 0.01f);
  EXPECT_NEAR(shadowShares(sceneOf(turnedInsideOut(cube)), set).at(0), want, 0.01f);
}

TEST(ShadowShares, OneThatFitsStaysAsItIs) {
  const SphereSet set = setOf({{{5, 6, 7}, 2.0f}});
  EXPECT_NEAR(shadowShares(sceneOf(shapes::moved(shapes::icosphere(2.0f, 24), {5, 6, 7})), set).at(0), 1.0f,
              0.01f);
}

// Spheres inside a body hide nothing that it does not hide; what two share is not counted twice.
TEST(ShadowShares, ManyTogetherShadowAsMuchAsTheObject) {
  std::vector<Sphere> string;
  constexpr int kCount = 24;
  for (int i = 0; i < kCount; ++i) {
    const float angle = 2.0f * kPi * float(i) / kCount;
    string.push_back({{std::cos(angle), 0, std::sin(angle)}, 0.2f});
  }
  const std::vector<float> shares = shadowShares(sceneOf(shapes::torus(1.0f, 0.1f, 96, 24)), setOf(string));
  for (const float share : shares) {
    EXPECT_LT(share, 0.72f) << "they stick out by half";
    EXPECT_GT(share, 0.5f);
    EXPECT_NEAR(share, shares[0], 0.06f) << "alike all round";
  }
  std::vector<Sphere> inner = {{glm::vec3(0.0f), 1.0f}, {glm::vec3(0.1f, 0, 0), 0.6f}};
  const std::vector<float> nested = shadowShares(sceneOf(shapes::icosphere(1.0f, 24)), setOf(inner));
  EXPECT_NEAR(nested[0], 1.0f, 0.02f);
  EXPECT_GT(nested[1], 0.95f) << "all of it is inside";
}

TEST(ShadowShares, NothingForWhatOnlyReceives) {
  EXPECT_TRUE(shadowShares(sceneOf(shapes::icosphere(1.0f, 4)), setOf({})).empty());
}

}  // namespace
}  // namespace gloam
