// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/sphere_bulges.h"

#include <gtest/gtest.h>

#include "scene/builtin_shapes.h"

namespace gloam {
namespace {

Scene sceneOf(Mesh mesh) {
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  return scene;
}

SphereSet setOf(std::vector<Sphere> spheres) {
  SphereSet set;
  set.meshes = {0};
  set.spheres = std::move(spheres);
  return set;
}

TEST(SphereBulges, ABallThatItsSphereFitsHasNone) {
  const Scene scene = sceneOf(shapes::moved(shapes::icosphere(1.0f, 12), {4, 0, 0}));
  EXPECT_NEAR(sphereBulges(scene, setOf({{{4, 0, 0}, 1.02f}}), {1.0f}).at(0), 0.01f, 0.006f);
}

TEST(SphereBulges, OfAPlateASphereStandsOutByHalf) {
  Mesh plate = shapes::box({-1.0f, -0.01f, -1.0f}, {1.0f, 0.01f, 1.0f}, 2.0f);
  EXPECT_NEAR(sphereBulges(sceneOf(plate), setOf({{{0, 0, 0}, 0.5f}}), {1.0f}).at(0), 0.49f, 0.02f);
  EXPECT_NEAR(sphereBulges(sceneOf(plate), setOf({{{0, 0, 0}, 0.5f}}), {0.5f}).at(0), 0.48f, 0.02f);
  for (std::size_t t = 0; t < plate.triangleCount(); ++t)
    std::swap(plate.indices[3 * t], plate.indices[3 * t + 1]);
  EXPECT_NEAR(sphereBulges(sceneOf(plate), setOf({{{0, 0, 0}, 0.5f}}), {1.0f}).at(0), 0.49f, 0.02f);
}

TEST(SphereBulges, WhereNoSurfaceLiesWithinThereIsNone) {
  const Scene scene = sceneOf(shapes::icosphere(1.0f, 12));
  EXPECT_EQ(sphereBulges(scene, setOf({{{0, 0, 0}, 1.0f}}), {0.5f}).at(0), 0.0f);
  EXPECT_TRUE(sphereBulges(scene, setOf({}), {}).empty());
}

}  // namespace
}  // namespace gloam
