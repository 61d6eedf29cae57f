// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Texels as points of a bake: coverage against slow twins, and the laws of prt_bake_test.cpp at texels.
#include "techniques/prt/prt_bake_texels.h"

#include <gloam/sh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/sampling.h"
#include "techniques/prt/prt_bake_test_scenes.h"

namespace gloam::prt {
namespace {

constexpr float kPi = sampling::kPi;

BakeOptions ofTexels(BakeOptions options, int texels, int uv_set = 0) {
  options.texels = texels;
  options.uv_set = uv_set;
  return options;
}

/// The whole of 0 to 1.
Mesh mapped(Mesh quad) {
  quad.uv_sets = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  return quad;
}

/// A cap's angle down and around.
Mesh mappedCap(Mesh cap, int rings, int columns) {
  cap.uv_sets.resize(1);
  for (int r = 0; r <= rings; ++r) {
    for (int c = 0; c <= columns; ++c)
      cap.uv_sets[0].emplace_back(float(c) / float(columns), float(r) / float(rings));
  }
  return cap;
}

glm::vec2 middleOf(const Transfer& t, std::size_t texel) {
  return (glm::vec2(float(texel % std::size_t(t.texel_width)), float(texel / std::size_t(t.texel_width))) +
          0.5f) /
         glm::vec2(float(t.texel_width), float(t.texel_height));
}

float directBrightness(const Transfer& t, std::size_t texel) {
  return t.direct[texel * std::size_t(t.order * t.order)] * std::sqrt(4.0f * kPi) / kPi;
}
float brightness(const Transfer& t, std::size_t texel) {
  return directBrightness(t, texel) +
         t.indirect[texel * 3 * std::size_t(t.order * t.order) + 1] * std::sqrt(4.0f * kPi) / kPi;
}

/// Random triangles of a lightmap, none over another.
Mesh scattered(int cells, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.08f, 0.92f);
  Mesh mesh;
  mesh.uv_sets.resize(1);
  for (int i = 0; i < cells * cells; i += 2) {
    for (int k = 0; k < 3; ++k) {
      const glm::vec2 cell(float(i % cells), float(i / cells));
      const glm::vec2 uv = (cell + glm::vec2(uniform(random), uniform(random))) / float(cells);
      mesh.uv_sets[0].push_back(uv);
      mesh.positions.emplace_back(3.0f * uv.x, 0.0f, 5.0f * uv.y);
      mesh.normals.emplace_back(0, 1, 0);
      mesh.indices.push_back(std::uint32_t(mesh.indices.size()));
    }
  }
  return mesh;
}

TEST(PrtBakeTexels, CoverageIsConservativeAndNearest) {
  const LightmapSize size{37, 23, 0};
  const Mesh mesh = scattered(7, 5);
  const std::vector<CoveredTexel> covered = coveredTexels(mesh, size);
  ASSERT_EQ(covered.size(), 37u * 23u);
  const glm::vec2 scale(37.0f, 23.0f);
  const auto place = [&](std::size_t triangle, float u, float v) {
    const auto& uv = mesh.uv_sets[0];
    return scale * ((1 - u - v) * uv[3 * triangle] + u * uv[3 * triangle + 1] + v * uv[3 * triangle + 2]);
  };
  std::vector<float> nearest(covered.size(), 1e9f);
  constexpr int kSteps = 40;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const glm::vec2 p = place(t, float(i) / kSteps, float(j) / kSteps);
        EXPECT_NE(covered[std::size_t(p.y) * 37 + std::size_t(p.x)].triangle, CoveredTexel::kNoTriangle)
            << "a texel that is touched";
        for (std::size_t texel = 0; texel < covered.size(); ++texel) {
          const glm::vec2 middle(float(texel % 37) + 0.5f, float(texel / 37) + 0.5f);
          nearest[texel] = std::min(nearest[texel], glm::distance(middle, p));
        }
      }
    }
  }
  int partly = 0;
  for (std::size_t texel = 0; texel < covered.size(); ++texel) {
    if (covered[texel].triangle == CoveredTexel::kNoTriangle) {
      EXPECT_GT(nearest[texel], std::sqrt(0.5f) - 0.001f);
      continue;
    }
    const glm::vec2 share = covered[texel].share;
    EXPECT_GE(std::min({share.x, share.y, 1.0f - share.x - share.y}), -1e-5f);
    const glm::vec2 middle(float(texel % 37) + 0.5f, float(texel / 37) + 0.5f);
    const float distance = glm::distance(middle, place(covered[texel].triangle, share.x, share.y));
    EXPECT_LE(distance, nearest[texel] + 1e-3f);
    partly += distance > 1e-3f;
  }
  EXPECT_GT(partly, 100);
}

TEST(PrtBakeTexels, GuttersHoldTheNearest) {
  Scene scene = sceneOf(scattered(5, 9));
  const PosedScene posed = pose(scene, 0.0f);
  BakePoints points = makeBakePoints(scene, posed);
  const std::size_t vertices = points.size();
  addTexels(points, scene, posed, {{41, 41, 0}});
  const TexelMap& map = points.texel_maps[0];
  ASSERT_EQ(map.points.size(), 41u * 41u);
  const auto placeOf = [](std::size_t texel) { return glm::ivec2(int(texel % 41), int(texel / 41)); };
  const auto apart = [&](std::size_t a, std::size_t b) {
    const glm::ivec2 way = placeOf(a) - placeOf(b);
    return way.x * way.x + way.y * way.y;
  };
  int gutter = 0;
  for (std::size_t texel = 0; texel < map.points.size(); ++texel) {
    ASSERT_GE(map.points[texel], vertices);
    ASSERT_LT(map.points[texel], points.size());
    const std::size_t own = points.facePoint(map.points[texel]).texel;
    int least = 1 << 30;
    for (const FacePoint& other : points.on_faces) least = std::min(least, apart(texel, other.texel));
    // Handing on the nearest may miss it by a little between two.
    EXPECT_LE(std::sqrt(float(apart(texel, own))), std::sqrt(float(least)) + 0.3f);
    gutter += own != texel;
  }
  EXPECT_GT(gutter, 300);
}

TEST(PrtBakeTexels, ConvexBodiesAreUnshadowed) {
  const Mesh sphere = mappedCap(sphereMesh(8, 16), 8, 16);
  const Scene baked = bakeTransfer(sceneOf(sphere), ofTexels(shadowed(5, 2048), 48));
  const Transfer& t = *baked.meshes[0].transfer;
  ASSERT_EQ(t.direct.size(), 48u * 48u * 25u);
  double squared = 0.0;
  float least = 2.0f;
  for (std::size_t texel = 0; texel < 48 * 48; ++texel) {
    least = std::min(least, directBrightness(t, texel));
    squared += std::pow(double(directBrightness(t, texel)) - 1.0, 2.0);
  }
  // Flat faces under smooth normals: what grazes them is lost.
  EXPECT_GT(least, 0.99f);
  EXPECT_LT(std::sqrt(squared / (48.0 * 48.0)), 0.002);
}

// As PrtBake.HalfPlaneBlocker; two triangles hold the whole shadow.
TEST(PrtBakeTexels, HalfPlaneBlocker) {
  const float height = 0.7f;
  Scene scene = sceneOf(mapped(quadMesh({0, 0, 0}, {0.0f, 0.0f, 0.9f}, {0.9f, 0.0f, 0.0f})));
  addMesh(scene, quadMesh({1, height / 2, 0}, {0, 0, 1e4f}, {0, height / 2, 0}));
  const Scene baked = bakeTransfer(scene, ofTexels(shadowed(5, 16384), 24));
  const Transfer& t = *baked.meshes[0].transfer;
  ASSERT_TRUE(t.ofTexels());
  EXPECT_FALSE(baked.meshes[1].transfer->ofTexels());
  float low = 1.0f, high = 0.0f;
  for (std::size_t texel = 0; texel < 24 * 24; ++texel) {
    const float distance = 1.0f - (2.0f * middleOf(t, texel).y - 1.0f) * 0.9f;
    const float expected = (1.0f + distance / std::hypot(height, distance)) / 2;
    EXPECT_NEAR(directBrightness(t, texel), expected, 0.004f) << texel;
    low = std::min(low, expected), high = std::max(high, expected);
  }
  EXPECT_GT(high - low, 0.3f);
}

TEST(PrtBakeTexels, WhatIsHiddenInsideDoesNotDarkenWhatIsSeen) {
  Scene scene = sceneOf(mapped(quadMesh({0, 0, 0}, {0, 0, 4}, {4, 0, 0})));
  Mesh box = boxMesh(glm::vec3(0.7f), false);
  for (glm::vec3& p : box.positions) p.y += 0.69f;
  addMesh(scene, box);
  const Scene baked = bakeTransfer(scene, ofTexels(shadowed(), 40));
  for (std::size_t texel = 0; texel < 40 * 40; ++texel)
    EXPECT_GT(directBrightness(*baked.meshes[0].transfer, texel), 0.45f) << texel;
}

// As PrtBake.OpenBowlHasTheRightPartialSums: texels send on what bounces.
TEST(PrtBakeTexels, OpenBowlHasTheRightPartialSums) {
  const float a = 0.6f, albedo = 0.6f, ratio = albedo * a, direct = albedo * (1.0f - a);
  Scene scene = sceneOf(mappedCap(bowlMesh(a, 16, 32), 16, 32));
  scene.materials[0].base_color = glm::vec4(glm::vec3(albedo), 1.0f);
  for (const int bounces : {1, 3}) {
    const Scene baked = bakeTransfer(scene, ofTexels(interreflected(bounces, 3, 8192, 1024), 32));
    const Transfer& t = *baked.meshes[0].transfer;
    const float total = direct * (1.0f - std::pow(ratio, float(bounces + 1))) / (1.0f - ratio);
    double sum = 0.0;
    for (std::size_t texel = 0; texel < 32 * 32; ++texel) {
      EXPECT_NEAR(albedo * brightness(t, texel) / total, 1.0f, 0.03f) << texel;
      sum += double(albedo * brightness(t, texel));
    }
    EXPECT_NEAR(sum / 1024.0 / double(total), 1.0, 0.01);
  }
}

// Light that falls through a slit onto a floor of two triangles, and from there upward: as from a floor of many vertices.
TEST(PrtBakeTexels, TexelsSendOnWhatTwoTrianglesDoNotHold) {
  const auto sentUp = [](const Mesh& floor, bool texels) {
    Scene scene = sceneOf(floor);
    addMesh(scene, quadMesh({0.7f, 0.45f, 0}, {0.05f, 0, 0}, {0, 0, 0.05f}));  // looks down
    for (const float side : {-1.0f, 1.0f})
      addMesh(scene, quadMesh({side * 20.3f, 0.5f, 0}, {20, 0, 0}, {0, 0, 40}));
    const BakeOptions options = interreflected(1, 3, 4096, 4096);
    const Scene baked = bakeTransfer(scene, texels ? ofTexels(options, 48) : options);
    return baked.meshes[1].transfer->indirect[1];
  };
  const Mesh two = mapped(quadMesh({0, 0, 0}, {0, 0, 3}, {3, 0, 0}));
  const float many = sentUp(gridMesh(3.0f, 48), false);
  EXPECT_NEAR(sentUp(two, true), many, 0.03f * many);
  EXPECT_GT(std::abs(sentUp(two, false) - many), 0.5f * many);
}

TEST(PrtBakeTexels, SameBitsForAnyNumberOfThreads) {
  Scene scene = crowdedScene();
  scene.meshes[0] = mappedCap(scene.meshes[0], 12, 24);
  scene.meshes[0].material = 0;
  BakeOptions options = ofTexels(interreflected(2, 3, 512, 256), 24);
  options.threads = 1;
  BakeReport report;
  const Scene one = bakeTransfer(scene, options, {}, &report);
  EXPECT_EQ(report.texels, 24u * 24u);
  EXPECT_EQ(report.warnings.size(), 1u);
  options.threads = 3;
  const Scene three = bakeTransfer(scene, options);
  for (std::size_t m = 0; m < one.meshes.size(); ++m) {
    EXPECT_EQ(one.meshes[m].transfer->direct, three.meshes[m].transfer->direct);
    EXPECT_EQ(one.meshes[m].transfer->indirect, three.meshes[m].transfer->indirect);
  }
}

// Matrices stay those of vertices, whatever the diffuse part is kept at.
TEST(PrtBakeTexels, GlossStaysOfVertices) {
  Scene scene = crowdedScene();
  scene.meshes[0] = mappedCap(scene.meshes[0], 12, 24);
  BakeOptions options = interreflected(1, 3, 512, 256);
  options.glossy = GlossyMeshes::kAll;
  const Scene plain = bakeTransfer(scene, options), texels = bakeTransfer(scene, ofTexels(options, 16));
  EXPECT_TRUE(texels.meshes[0].transfer->ofTexels());
  EXPECT_EQ(plain.meshes[0].transfer->glossy.visibility, texels.meshes[0].transfer->glossy.visibility);
  EXPECT_EQ(plain.meshes[0].transfer->glossy.indirect, texels.meshes[0].transfer->glossy.indirect);
}

TEST(PrtBakeTexels, WhatCannotHoldALightmapIsTold) {
  const Mesh good = mapped(quadMesh({0, 0, 0}, {0, 0, 1}, {1, 0, 0}));
  EXPECT_EQ(unfitForLightmap(good, 0), "");
  EXPECT_EQ(unfitForLightmap(good, 1), "no TEXCOORD_1");
  Mesh beyond = good;
  beyond.uv_sets[0][2] = {1.01f, 1.0f};
  EXPECT_EQ(unfitForLightmap(beyond, 0), "TEXCOORD_0 leaves 0 to 1");
  Mesh folded = good;
  folded.uv_sets[0] = {{0, 0}, {1, 0}, {1, 1}, {1, 0}};
  EXPECT_EQ(unfitForLightmap(folded, 0), "triangles lie over each other in TEXCOORD_0");
  Mesh nothing = good;
  nothing.uv_sets[0].assign(4, glm::vec2(0.5f));
  EXPECT_EQ(unfitForLightmap(nothing, 0), "TEXCOORD_0 covers nothing");
  Mesh bad = good;
  bad.uv_sets[0][0].x = NAN;
  EXPECT_NE(unfitForLightmap(bad, 0), "");

  Scene scene = sceneOf(folded);
  scene.meshes[0].name = "folded";
  EXPECT_THROW(
      try { bakeTransfer(scene, ofTexels(shadowed(3, 256), 16)); } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("'folded'"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("expected"), std::string::npos);
        throw;
      },
      Error);
  addMesh(scene, good);
  BakeReport report;
  const Scene baked = bakeTransfer(scene, ofTexels(shadowed(3, 256), 16), {}, &report);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("'folded'"), std::string::npos) << report.warnings[0];
  EXPECT_FALSE(baked.meshes[0].transfer->ofTexels());
  EXPECT_TRUE(baked.meshes[1].transfer->ofTexels());
  EXPECT_THROW(bakeTransfer(scene, ofTexels(shadowed(3, 256), 3)), Error);
  EXPECT_THROW(bakeTransfer(scene, ofTexels(shadowed(3, 256), 5000)), Error);
}

TEST(PrtBakeTexels, DensityCountsInTheWorld) {
  Scene scene = sceneOf(mapped(quadMesh({0, 0, 0}, {0, 0, 1}, {2, 0, 0})));
  scene.nodes[0].scale = glm::vec3(2.0f);
  BakeOptions options = shadowed(3, 256);
  options.texels_per_metre = 5.0f;
  options.uv_set = 0;
  const Transfer t = *bakeTransfer(scene, options).meshes[0].transfer;
  EXPECT_EQ(t.texel_width, 20);  // u runs along 4 m
  EXPECT_EQ(t.texel_height, 40);
  options.texels = 32;
  EXPECT_EQ(bakeTransfer(scene, options).meshes[0].transfer->texel_height, 32);
  EXPECT_EQ(estimateBake(scene, options).texels, 20u * 32u);
}

}  // namespace
}  // namespace gloam::prt
