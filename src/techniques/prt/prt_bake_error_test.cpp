// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Directions until the error is below a bound, and bakes held to a size (PRT-3).
#include <gloam/bake.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "techniques/prt/prt_bake_measures.h"
#include "techniques/prt/prt_bake_test_scenes.h"

namespace gloam::prt {
namespace {

BakeOptions until(float error, BakeOptions options) {
  options.error = error;
  options.directions = 32768;
  return options;
}

bool sameBits(const Scene& a, const Scene& b) {
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    const Transfer &s = *a.meshes[m].transfer, &t = *b.meshes[m].transfer;
    if (s.direct != t.direct || s.indirect != t.indirect) return false;
    if (s.glossy.visibility != t.glossy.visibility || s.glossy.indirect != t.glossy.indirect) return false;
  }
  return true;
}

/// RMS over vertices of |a - b|, as a part of the norm of an open vertex's transfer.
struct Error {
  double direct = 0.0, indirect = 0.0;
};
Error errorOf(const Scene& a, const Scene& b) {
  Error error;
  double open = 0.0, count = 0.0;
  BakeOptions none = shadowed(5);
  none.kind = TransferKind::kUnshadowed;
  const Scene unshadowed = bakeTransfer(sceneOf(quadMesh({0, 0, 0}, {1, 0, 0}, {0, 0, -1})), none);
  for (const float value : unshadowed.meshes[0].transfer->direct) open += double(value) * double(value) / 4.0;
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    const Transfer &s = *a.meshes[m].transfer, &t = *b.meshes[m].transfer;
    for (std::size_t i = 0; i < s.direct.size(); ++i)
      error.direct += std::pow(double(s.direct[i]) - double(t.direct[i]), 2.0);
    for (std::size_t i = 0; i < s.indirect.size(); i += 3)
      error.indirect += std::pow(double(s.indirect[i]) - double(t.indirect[i]), 2.0);
    count += double(a.meshes[m].vertexCount());
  }
  return {std::sqrt(error.direct / count / open), std::sqrt(error.indirect / count / open)};
}

TEST(PrtBakeError, TheErrorThatIsToldIsTheErrorThatIs) {
  const Scene scene = crowdedScene();
  const Scene truth = bakeTransfer(scene, shadowed(5, 65536));
  double last_mean = 0.0;
  for (const float bound : {0.02f, 0.01f, 0.004f}) {
    BakeReport report;
    const Scene baked = bakeTransfer(scene, until(bound, shadowed(5)), {}, &report);
    const double error = errorOf(baked, truth).direct;
    RecordProperty("error", std::to_string(error));
    EXPECT_LT(error, 1.1 * double(bound)) << "told " << report.error;
    EXPECT_GT(report.error, 0.6 * error) << bound;
    EXPECT_LT(report.error, 2.5 * error) << bound;
    EXPECT_EQ(report.above_error, 0u);
    EXPECT_GT(report.mean_directions, last_mean);
    EXPECT_LE(report.mean_directions, report.most_directions);
    EXPECT_GT(report.rays_saved, report.rays / 2);
    last_mean = report.mean_directions;
  }
}

TEST(PrtBakeError, TheFirstBounceIsAsGood) {
  const Scene scene = crowdedScene();
  const Scene truth = bakeTransfer(scene, interreflected(1, 5, 32768, 32768));
  BakeReport tight, loose;
  const Scene near = bakeTransfer(scene, until(0.002f, interreflected(1, 5)), {}, &tight);
  const Scene far = bakeTransfer(scene, until(0.02f, interreflected(1, 5)), {}, &loose);
  EXPECT_LT(errorOf(near, truth).indirect, 0.002);
  EXPECT_LT(errorOf(far, truth).indirect, 0.02);
  EXPECT_LT(loose.bounce_rays, tight.bounce_rays);
}

/// A floor with two balls of metal close to each other, which throw light on it and on one another.
Scene metalScene(float roughness) {
  Scene scene = sceneOf(gridMesh(2.0f, 6));
  for (const float x : {-0.55f, 0.55f}) {
    Mesh ball = sphereMesh(6, 12);
    for (glm::vec3& p : ball.positions) p = 0.5f * p + glm::vec3(x, 0.52f, 0.0f);
    ball.material = int(scene.materials.size());
    addMesh(scene, ball);
  }
  Material metal;
  metal.base_color = {1.0f, 0.8f, 0.5f, 1.0f};
  metal.metallic = 1.0f;
  metal.roughness = roughness;
  scene.materials.push_back(metal);
  for (std::size_t m = 1; m < 3; ++m) scene.meshes[m].material = int(scene.materials.size()) - 1;
  return scene;
}

// Light that comes by way of metal: followed from mirror to mirror, or sent on by matrices; to vectors and to matrices. All
// of it is as well known as is asked for.
TEST(PrtBakeError, LightByWayOfMetalIsAsGood) {
  for (const float roughness : {0.15f, 0.6f}) {
    const Scene scene = metalScene(roughness);
    for (const GlossyMeshes glossy : {GlossyMeshes::kNone, GlossyMeshes::kShiny}) {
      if (roughness > 0.5f && glossy == GlossyMeshes::kNone) continue;  // followed as the sharper one is
      BakeOptions options = interreflected(2, 3, 32768, 32768);
      options.glossy = glossy;
      const Scene truth = bakeTransfer(scene, options);
      double last_rays = 0.0;
      for (const float bound : {0.03f, 0.01f}) {
        BakeOptions adaptive = until(bound, options);
        adaptive.bounce_directions = 256;
        BakeReport report;
        const Scene baked = bakeTransfer(scene, adaptive, {}, &report);
        EXPECT_LT(errorOf(baked, truth).indirect, double(bound)) << roughness << " " << int(glossy);
        EXPECT_GT(double(report.bounce_rays), 1.2 * last_rays);
        last_rays = double(report.bounce_rays);
      }
    }
  }
}

TEST(PrtBakeError, OneStepOfDirectionsTellsNoError) {
  BakeOptions options = until(0.01f, shadowed(3));
  options.directions = 512;
  EXPECT_THROW(bakeTransfer(crowdedScene(), options), gloam::Error);
  options.kind = TransferKind::kUnshadowed;  // takes none
  EXPECT_NO_THROW(bakeTransfer(crowdedScene(), options));
}

TEST(PrtBakeError, PointsWithoutShadowTakeFewDirections) {
  BakeReport report;
  bakeTransfer(sceneOf(sphereMesh(8, 16)), until(0.001f, shadowed(5)), {}, &report);
  EXPECT_LE(report.most_directions, 2048);
  EXPECT_EQ(report.error, 0.0);
}

TEST(PrtBakeError, WhatCannotBeReachedIsTold) {
  BakeOptions options = until(0.0005f, shadowed(5));
  options.directions = 1024;
  BakeReport report;
  bakeTransfer(crowdedScene(), options, {}, &report);
  EXPECT_EQ(report.most_directions, 1024);
  EXPECT_GT(report.above_error, 100u);
}

TEST(PrtBakeError, MatricesAreKnownAsWell) {
  BakeOptions options = until(0.02f, interreflected(1, 3, 2048, 512));
  options.glossy = GlossyMeshes::kAll;
  BakeReport vectors, matrices;
  const Scene baked = bakeTransfer(crowdedScene(), options, {}, &matrices);
  options.glossy = GlossyMeshes::kNone;
  bakeTransfer(crowdedScene(), options, {}, &vectors);
  EXPECT_GT(matrices.mean_directions, vectors.mean_directions);
  EXPECT_FALSE(baked.meshes[0].transfer->glossy.empty());
}

// Threads, interruptions, memory: none of them shows.
TEST(PrtBakeError, SameBitsHoweverItIsDone) {
  Scene scene = crowdedScene();
  scene.materials[1].metallic = 1.0f;
  scene.materials[1].roughness = 0.1f;
  BakeOptions options = until(0.01f, interreflected(4, 4));
  const auto file = std::filesystem::path(testing::TempDir()) / "PrtBakeErrorSameBits.ckp";
  for (const float error : {0.0f, 0.01f}) {
    options.error = error;
    options.directions = 4096;
    options.threads = 1;
    options.memory_bytes = 0;
    options.checkpoint.clear();
    const Scene whole = bakeTransfer(scene, options);
    options.threads = 3;
    EXPECT_TRUE(sameBits(whole, bakeTransfer(scene, options)));
    options.memory_bytes = estimateBake(scene, options).least_memory_bytes + 100000;
    BakeReport frugal;
    EXPECT_TRUE(sameBits(whole, bakeTransfer(scene, options, {}, &frugal)));
    options.memory_bytes = 0;
    BakeReport lavish;
    bakeTransfer(scene, options, {}, &lavish);
    EXPECT_GT(frugal.bounce_rays, lavish.bounce_rays);

    std::filesystem::remove(file);
    options.checkpoint = file;
    for (int interruptions = 0;; ++interruptions) {
      ASSERT_LT(interruptions, 1000);
      Progress progress;
      int asked = 0;
      progress.should_stop = [&] { return ++asked > 25; };
      try {
        EXPECT_TRUE(sameBits(whole, bakeTransfer(scene, options, progress)));
        EXPECT_GT(interruptions, 2);
        break;
      } catch (const Interrupted&) {
      }
    }
  }
}

TEST(PrtBakeError, MemoryThatDoesNotSufficeIsRefused) {
  BakeOptions options = interreflected(2, 5);
  const BakeEstimate estimate = estimateBake(crowdedScene(), options);
  EXPECT_LT(estimate.least_memory_bytes, estimate.memory_bytes);
  options.memory_bytes = estimate.least_memory_bytes - 1;
  try {
    bakeTransfer(crowdedScene(), options);
    FAIL();
  } catch (const gloam::Error& error) {
    EXPECT_NE(std::string(error.what()).find("memory_bytes is"), std::string::npos) << error.what();
  }
  options.memory_bytes = estimate.least_memory_bytes + 1000;
  EXPECT_LE(estimateBake(crowdedScene(), options).memory_bytes, options.memory_bytes);
  for (const float error : {-1.0f, 1e-6f, 2.0f, std::nanf("")}) {
    BakeOptions bad = shadowed();
    bad.error = error;
    EXPECT_THROW(bakeTransfer(crowdedScene(), bad), gloam::Error);
  }
}

}  // namespace
}  // namespace gloam::prt
