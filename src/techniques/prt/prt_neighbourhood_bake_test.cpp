// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baking neighbourhoods (PRT-6): against what can be worked out by hand, and how a bake runs.
#include <gloam/bake.h>
#include <gloam/neighbourhood.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>

#include "math/sampling.h"
#include "math/sh_high_order.h"
#include "techniques/prt/prt_bake_test_scenes.h"
#include "techniques/prt/prt_neighbourhood_field.h"

namespace gloam::prt {
namespace {

constexpr float kPi = sampling::kPi;

NeighbourhoodOptions small(int points = 6, int order = 3) {
  NeighbourhoodOptions options;
  options.size = {points, 0, 0};
  options.order = order;
  options.directions = 4096;
  options.thrown_directions = 1024;
  options.error_points = 0;
  return options;
}

Scene bakedSphere(const Material& material, TransferKind kind = TransferKind::kShadowed) {
  Scene scene = sceneOf(sphereMesh(32, 64));
  scene.materials[0] = material;
  BakeOptions options = shadowed(3, 1024);
  options.kind = kind;
  options.apart = true;
  return bakeTransfer(scene, options);
}

/// What a sphere of radius 1 about the origin blocks: a cone about -place of half-angle asin(1 / distance).
float blockedShare(float distance) {
  return 0.5f * (1.0f - std::sqrt(1.0f - 1.0f / (distance * distance)));
}

TEST(PrtNeighbourhood, SphereBlocksItsCone) {
  const Scene scene = sceneOf(sphereMesh(48, 96));
  NeighbourhoodReport report;
  const NeighbourhoodTransfer grid = bakeNeighbourhood(scene, 0, small(7), {}, &report);
  EXPECT_EQ(grid.size, glm::ivec3(7));
  EXPECT_TRUE(grid.indirect.empty());  // nothing was baked that it could throw
  EXPECT_EQ(report.points, 343u);
  EXPECT_GT(report.inside, 0u);
  for (std::size_t p = 0; p < grid.points(); ++p) {
    const glm::vec3 place = grid.position(p);
    const float distance = glm::length(place);
    if (distance < 1.01f) continue;
    const float* v = &grid.visibility[p * grid.visibilityCount()];
    const float share = blockedShare(distance);
    EXPECT_NEAR(v[0] / std::sqrt(4.0f * kPi), 1.0f - share, 0.01f);
    // Band 1 of a cap: sqrt(4 pi / 3) times its zonal coefficient, towards its axis; missing there.
    const glm::vec3 axis = -place / distance;
    const float zonal = std::sqrt(3.0f / (4.0f * kPi)) * kPi / (distance * distance);
    const glm::vec3 band(v[3], v[1], v[2]);
    EXPECT_LT(glm::length(band + zonal * axis), 0.02f);
  }
}

TEST(PrtNeighbourhood, PointsInsideHoldWhatIsOutside) {
  const Scene scene = sceneOf(sphereMesh(24, 48));
  NeighbourhoodReport report;
  const NeighbourhoodTransfer grid = bakeNeighbourhood(scene, 0, small(10), {}, &report);
  ASSERT_GE(report.inside, 8u);
  for (std::size_t p = 0; p < grid.points(); ++p) {
    const float open = grid.visibility[p * grid.visibilityCount()] / std::sqrt(4.0f * kPi);
    EXPECT_GT(open, 0.4f);  // at the surface half of the sphere is open
    EXPECT_LT(open, 1.0f);
  }
}

// A white sphere under light of 1 from everywhere is 1 all over: what it blocks it gives back.
TEST(PrtNeighbourhood, WhiteObjectInTheWhiteFurnaceThrowsWhatItBlocks) {
  const Scene scene = bakedSphere({.metallic = 0.0f, .specular = 0.0f});
  const NeighbourhoodTransfer grid = bakeNeighbourhood(scene, 0, small());
  ASSERT_FALSE(grid.indirect.empty());
  EXPECT_EQ(grid.bounces, 1);
  sh::ShRgb white(3);
  white.c[0] = glm::vec3(std::sqrt(4.0f * kPi));
  for (const glm::vec3 place : {glm::vec3(1.7f, 0.4f, 0.3f), glm::vec3(-0.3f, 2.2f, -1.0f)}) {
    const NeighbourhoodField field = fieldAt(grid, place, white);
    for (int i = 0; i < 9; ++i) {
      const glm::vec3 sum = field.direct.c[std::size_t(i)] + field.thrown.c[std::size_t(i)];
      EXPECT_NEAR(sum.g, i == 0 ? std::sqrt(4.0f * kPi) : 0.0f, 0.04f) << i;
    }
  }
}

// A perfect mirror does so, too; and under light from above it throws a highlight on what stands beside it, where a diffuse
// body of the same albedo throws less of it.
TEST(PrtNeighbourhood, MirrorsThrowTheLightThatTheyReflect) {
  const Scene scene = bakedSphere({.metallic = 1.0f, .roughness = 0.05f});
  const NeighbourhoodTransfer grid = bakeNeighbourhood(scene, 0, small());
  sh::ShRgb white(3), above(3);
  white.c[0] = glm::vec3(std::sqrt(4.0f * kPi));
  const glm::vec3 place(1.8f, 0.2f, 0.1f);
  NeighbourhoodField field = fieldAt(grid, place, white);
  for (int i = 0; i < 9; ++i) {
    const glm::vec3 sum = field.direct.c[std::size_t(i)] + field.thrown.c[std::size_t(i)];
    EXPECT_NEAR(sum.g, i == 0 ? std::sqrt(4.0f * kPi) : 0.0f, 0.04f) << i;
  }
  // The middle of the sphere shows what comes from +X there: light from +X is thrown back to +X.
  const sh::Sh from_x = sh::evaluate(3, {1, 0, 0});
  for (int i = 0; i < 9; ++i) above.c[std::size_t(i)] = glm::vec3(from_x[i]);
  field = fieldAt(grid, place, above);
  EXPECT_GT(sh::irradiance(field.thrown, {-1, 0, 0}).g, 0.0f);
}

TEST(PrtNeighbourhood, TurnsAndScalesWithItsNode) {
  Scene scene = sceneOf(boxMesh({0.5f, 0.2f, 0.3f}, false));
  const NeighbourhoodTransfer before = bakeNeighbourhood(scene, 0, small(5));
  scene.nodes[0].matrix = glm::translate(glm::mat4(1.0f), {3, -1, 2}) *
                          glm::rotate(glm::mat4(1.0f), 0.9f, glm::normalize(glm::vec3(1, 2, -1))) *
                          glm::scale(glm::mat4(1.0f), glm::vec3(2.5f));
  const NeighbourhoodTransfer after = bakeNeighbourhood(scene, 0, small(5));
  ASSERT_EQ(before.size, after.size);
  EXPECT_LT(glm::length(before.first_point - after.first_point), 1e-4f);
  double difference = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < before.visibility.size(); ++i) {
    difference += std::pow(double(before.visibility[i] - after.visibility[i]), 2.0);
    whole += std::pow(double(before.visibility[i]), 2.0);
  }
  EXPECT_LT(std::sqrt(difference / whole), 0.01);  // directions within the object are the same up to rounding
}

TEST(PrtNeighbourhood, FinerGridsErrLess) {
  const Scene scene = sceneOf(sphereMesh(24, 48));
  double last = 1.0;
  for (const int points : {6, 12, 20}) {
    NeighbourhoodOptions options = small(points);
    options.directions = 1024;
    options.error_points = 200;
    NeighbourhoodReport report;
    bakeNeighbourhood(scene, 0, options, {}, &report);
    EXPECT_LT(report.error, 0.8 * last) << points;
    last = report.error;
  }
  EXPECT_LT(last, 0.03);
}

bool sameBits(const NeighbourhoodTransfer& a, const NeighbourhoodTransfer& b) {
  return a.visibility == b.visibility && a.indirect == b.indirect && a.first_point == b.first_point;
}

TEST(PrtNeighbourhood, SameBitsForAnyNumberOfThreadsAndAfterInterruptions) {
  const Scene scene = bakedSphere({.metallic = 0.5f, .roughness = 0.3f});
  NeighbourhoodOptions options = small();
  options.directions = 512;
  options.threads = 1;
  const NeighbourhoodTransfer one = bakeNeighbourhood(scene, 0, options);
  options.threads = 3;
  EXPECT_TRUE(sameBits(one, bakeNeighbourhood(scene, 0, options)));
  options.checkpoint = std::filesystem::path(testing::TempDir()) / "neighbourhood.ckp";
  std::filesystem::remove(options.checkpoint);
  for (int interruptions = 0;; ++interruptions) {
    ASSERT_LT(interruptions, 1000);
    Progress progress;  // stops soon after the first points are under way
    std::atomic<int> asked{0};
    std::atomic<bool> begun{false};
    progress.update = [&](double, const std::string& what) {
      if (what.find("neighbourhood") != std::string::npos) begun = true;
    };
    progress.should_stop = [&] { return begun && ++asked > 3; };
    NeighbourhoodReport report;
    try {
      EXPECT_TRUE(sameBits(one, bakeNeighbourhood(scene, 0, options, progress, &report)));
      EXPECT_TRUE(report.resumed);
      EXPECT_GT(interruptions, 2);
      break;
    } catch (const Interrupted&) {
      ASSERT_TRUE(std::filesystem::exists(options.checkpoint));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(options.checkpoint));
  std::ofstream(options.checkpoint) << "a letter to someone";
  EXPECT_THROW(bakeNeighbourhood(scene, 0, options), Error);
  EXPECT_TRUE(std::filesystem::exists(options.checkpoint));
  std::filesystem::remove(options.checkpoint);
}

std::string errorOf(const Scene& scene, const NeighbourhoodOptions& options) {
  try {
    bakeNeighbourhood(scene, 0, options);
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "no error";
}

TEST(PrtNeighbourhood, SaysWhatItCannotDo) {
  Scene scene = sceneOf(sphereMesh(8, 16));
  NeighbourhoodOptions options = small();
  options.reach = -1.0f;
  EXPECT_NE(errorOf(scene, options).find("reach is -1"), std::string::npos);
  options = small(129);
  EXPECT_NE(errorOf(scene, options).find("129"), std::string::npos);
  options = small(64, 6);
  options.memory_bytes = std::size_t(1) << 30;
  EXPECT_NE(errorOf(scene, options).find("64 x 64 x 64 points takes"), std::string::npos);
  EXPECT_GT(estimateNeighbourhood(scene, 0, options).memory_bytes, options.memory_bytes);
  scene.nodes[0].meshes.clear();
  scene.nodes[0].name = "empty";
  EXPECT_NE(errorOf(scene, small()).find("node 'empty'"), std::string::npos);
}

}  // namespace
}  // namespace gloam::prt
