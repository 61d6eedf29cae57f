// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/mesh_repair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/scene_archive.h"
#include "scene/scene_check.h"

namespace gloam {
namespace {

/// A sphere of rings x 2 rings quads; every triangle has corners of its own.
Mesh sphereSoup(int rings) {
  Mesh mesh;
  const auto add = [&](int ring, int step) {
    const double radius = ring % rings == 0 ? 0.0 : 1.0;  // exact poles
    const double theta = std::numbers::pi * ring / rings,
                 phi = std::numbers::pi * (step % (2 * rings)) / rings;
    mesh.positions.emplace_back(radius * std::sin(theta) * std::cos(phi), std::cos(theta),
                                -radius * std::sin(theta) * std::sin(phi));
    mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size() - 1));
  };
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < 2 * rings; ++s) {
      add(r, s), add(r + 1, s), add(r + 1, s + 1);
      add(r, s), add(r + 1, s + 1), add(r, s + 1);
    }
  return mesh;
}

Mesh box() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
  mesh.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return mesh;
}

TEST(MeshRepair, SmoothNormalsOfASphereAreRadialEvenWithoutSharedVertices) {
  Mesh mesh = sphereSoup(32);
  removeDegenerateTriangles(mesh);
  removeUnusedVertices(mesh);
  computeNormals(mesh, kSmoothCreaseRad);
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i)
    EXPECT_GT(glm::dot(mesh.normals[i], glm::normalize(mesh.positions[i])), std::cos(0.02f));
}

TEST(MeshRepair, ACreaseKeepsTheEdgesOfABox) {
  Mesh mesh = box();
  computeNormals(mesh, kSmoothCreaseRad);
  EXPECT_EQ(mesh.vertexCount(), 24u);  // three normals a corner, both triangles of a side share theirs
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::uint32_t* t = &mesh.indices[i / 3 * 3];
    const glm::vec3 flat = glm::normalize(
        glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]));
    EXPECT_NEAR(glm::dot(flat, mesh.normals[mesh.indices[i]]), 1.0f, 1e-6f);
  }
  Mesh round = box();
  computeNormals(round, 1.7f);  // 97 degrees: the edges go
  EXPECT_EQ(round.vertexCount(), 8u);
  for (std::size_t i = 0; i < 8; ++i)  // angle weights: independent of how the sides are cut into triangles
    EXPECT_NEAR(glm::dot(round.normals[i], glm::normalize(round.positions[i] - 0.5f)), 1.0f, 1e-6f);
}

// Closed meshes with a face that lies the wrong way round, or is folded over its neighbours: no vertex may look inward.
TEST(MeshRepair, FacesUpsideDownTakeTheNormalsOfTheirNeighbours) {
  Mesh sphere = sphereSoup(16);
  removeDegenerateTriangles(sphere);
  removeUnusedVertices(sphere);
  const auto flip = [](Mesh& mesh, std::size_t face) {
    std::swap(mesh.indices[3 * face], mesh.indices[3 * face + 1]);
  };
  const std::size_t faces = sphere.triangleCount();
  for (const std::size_t face : {std::size_t(3), faces / 2, faces - 7}) {
    Mesh flipped = sphere;
    flip(flipped, face);
    Mesh folded = sphere;  // once more on top, and once more upside down: each edge still has its pairs
    for (const bool down : {false, true}) {
      for (std::size_t k = 0; k < 3; ++k) folded.indices.push_back(sphere.indices[3 * face + k]);
      if (down) flip(folded, folded.triangleCount() - 1);
    }
    for (Mesh* mesh : {&flipped, &folded}) {
      computeNormals(*mesh, kSmoothCreaseRad);
      for (std::size_t i = 0; i < mesh->vertexCount(); ++i)
        EXPECT_GT(glm::dot(mesh->normals[i], glm::normalize(mesh->positions[i])), std::cos(0.15f)) << face;
    }
  }
}

TEST(MeshRepair, ThinBodiesKeepBothSides) {
  Mesh plate = box();  // without height
  for (glm::vec3& p : plate.positions) p.y *= 1e-3f;
  computeNormals(plate, kSmoothCreaseRad);
  EXPECT_EQ(plate.vertexCount(), 24u);
  Mesh leaf;  // a sheet that was given a back
  leaf.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  leaf.indices = {0, 1, 2, 0, 2, 3, 2, 1, 0, 3, 2, 0};
  computeNormals(leaf, kSmoothCreaseRad);
  ASSERT_EQ(leaf.vertexCount(), 8u);
  for (std::size_t i = 0; i < leaf.indices.size(); ++i)
    EXPECT_NEAR(leaf.normals[leaf.indices[i]].z, i < 6 ? 1.0f : -1.0f, 1e-6f);
  Mesh wedge;  // a blade's edge of 20 degrees
  wedge.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0.18f, 0}, {1, 0.18f, 1}, {1, -0.18f, 0}, {1, -0.18f, 1}};
  wedge.indices = {0, 1, 3, 0, 3, 2, 0, 5, 1, 0, 4, 5};
  computeNormals(wedge, kSmoothCreaseRad);
  for (std::size_t i = 0; i < wedge.indices.size(); ++i)
    EXPECT_GT(wedge.normals[wedge.indices[i]].y * (i < 6 ? 1.0f : -1.0f), 0.9f);
}

TEST(MeshRepair, AConeOfManyFlatSidesIsSplitAtItsTip) {
  Mesh mesh;
  constexpr std::uint32_t n = 50000;
  mesh.positions.emplace_back(0, 1, 0);
  for (std::uint32_t i = 0; i < n; ++i) {
    const double phi = 2.0 * std::numbers::pi * i / n;
    mesh.positions.emplace_back(std::cos(phi), 0, -std::sin(phi));
    mesh.indices.insert(mesh.indices.end(), {0, 1 + i, 1 + (i + 1) % n});
  }
  computeNormals(mesh, kFlat);
  EXPECT_GT(mesh.vertexCount(), 2u * n);  // nearly all sides differ; rounding joins some
}

TEST(MeshRepair, RemappingTakesEveryArrayAlong) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.normals = mesh.positions;
  mesh.uv_sets = {{{0, 0}, {1, 1}, {2, 2}}};
  mesh.influences = 4;
  for (std::uint16_t i = 0; i < 12; ++i) mesh.joints.push_back(i), mesh.weights.push_back(i);
  mesh.morph_targets.resize(1);
  mesh.morph_targets[0].positions = mesh.positions;
  Transfer transfer;
  transfer.order = 2;
  for (int i = 0; i < 12; ++i) transfer.direct.push_back(static_cast<float>(i));
  for (int i = 0; i < 36; ++i) transfer.indirect.push_back(static_cast<float>(i));
  mesh.transfer = std::make_shared<Transfer>(transfer);
  const std::uint32_t source[] = {2, 0, 2, 1};
  remapVertices(mesh, source);
  EXPECT_EQ(mesh.positions[0].x, 2.0f);
  EXPECT_EQ(mesh.uv_sets[0][3], glm::vec2(1, 1));
  EXPECT_EQ(mesh.joints[0], 8);
  EXPECT_EQ(mesh.weights[4], 0.0f);
  EXPECT_EQ(mesh.morph_targets[0].positions[2].x, 2.0f);
  EXPECT_EQ(mesh.transfer->direct.size(), 16u);
  EXPECT_EQ(mesh.transfer->direct[0], 8.0f);
  EXPECT_EQ(mesh.transfer->indirect[3 * 4 * 3], 12.0f);
}

TEST(MeshRepair, TrianglesThatMorphOpenAreKept) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.indices = {0, 1, 2, 0, 0, 1};
  Mesh morphing = mesh;
  morphing.morph_targets.resize(1);
  EXPECT_EQ(removeDegenerateTriangles(mesh), 2u);
  EXPECT_EQ(removeDegenerateTriangles(morphing), 1u);
}

TEST(MeshRepair, TinyTrianglesHaveArea) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1e-15f, 0, 0}, {0, 1e-15f, 0}};
  mesh.indices = {0, 1, 2};
  EXPECT_EQ(removeDegenerateTriangles(mesh), 0u);
  computeNormals(mesh, kFlat);
  EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1));
}

Scene smallScene() {
  Scene scene;
  scene.materials.emplace_back().name = "m";
  Mesh mesh = box();
  MeshRepairs repairs;
  EXPECT_TRUE(finishMesh(mesh, scene.materials[0], kFlat, "box", repairs));
  EXPECT_TRUE(repairs.lines().empty());
  scene.meshes.push_back(mesh);
  scene.nodes.resize(2);
  scene.nodes[0].children = {1};
  scene.nodes[1].parent = 0;
  scene.nodes[1].meshes = {0};
  scene.nodes[1].matrix = glm::mat4(2.0f);
  scene.roots = {0};
  scene.textures.push_back({"t", 1, 1, {1, 2, 3, 4}});
  scene.cameras.emplace_back().name = "c";
  scene.lights.emplace_back().intensity = {1, 2, 3};
  scene.skins.push_back({{1}, {glm::mat4(3.0f)}});
  scene.animations.push_back(
      {"a",
       {{1, AnimationChannel::Path::kScale, AnimationChannel::Interpolation::kStep, {0.0f}, {1, 2, 3}, 3}}});
  scene.warnings = {"w"};
  return scene;
}

TEST(SceneArchive, UnpackGivesBackWhatWasPacked) {
  Scene scene = smallScene();
  const std::vector<std::uint8_t> bytes = packScene(scene);
  Scene again = unpackScene(bytes);
  EXPECT_EQ(packScene(again), bytes);
  EXPECT_EQ(again.meshes[0].positions, scene.meshes[0].positions);
  EXPECT_EQ(again.nodes[1].matrix, scene.nodes[1].matrix);
  EXPECT_FALSE(again.nodes[0].matrix);
  EXPECT_EQ(again.animations[0].channels[0].values, scene.animations[0].channels[0].values);
  EXPECT_EQ(again.warnings, scene.warnings);
  checkScene(again, "again");
}

TEST(SceneArchive, CutOrDamagedBytesAreRefusedOrGiveASceneThatTheCheckJudges) {
  Scene scene = smallScene();
  const std::vector<std::uint8_t> bytes = packScene(scene);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(unpackScene({bytes.data(), size}), Error) << size;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::vector<std::uint8_t> bad = bytes;
    bad[at] ^= 0x5a;
    try {
      const Scene read = unpackScene(bad);
      checkScene(read, "bad", SceneStage::kImported);
    } catch (const Error&) {
    }
  }
}

TEST(SceneCheck, BrokenPromisesAreFound) {
  const Scene good = smallScene();
  checkScene(good, "good");
  const auto refused = [&](auto bend) {
    Scene scene = good;
    bend(scene);
    try {
      checkScene(scene, "scene");
    } catch (const Error&) {
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refused([](Scene& s) { s.meshes[0].indices[0] = 99; }));
  EXPECT_TRUE(refused([](Scene& s) { s.meshes[0].normals.pop_back(); }));
  EXPECT_TRUE(refused([](Scene& s) { s.meshes[0].material = 1; }));
  EXPECT_TRUE(refused([](Scene& s) { s.materials[0].normal_map.texture = 3; }));
  EXPECT_TRUE(refused([](Scene& s) { s.materials[0].normal_map.texture = 0; }));  // no texture coordinates
  EXPECT_TRUE(refused([](Scene& s) { s.nodes[1].meshes = {1}; }));
  EXPECT_TRUE(refused([](Scene& s) { s.nodes[1].parent = kNone; }));
  EXPECT_TRUE(refused([](Scene& s) { s.nodes[1].skin = 2; }));
  EXPECT_TRUE(refused([](Scene& s) { s.roots = {0, 1}; }));
  EXPECT_TRUE(refused([](Scene& s) { s.roots = {}; }));
  EXPECT_TRUE(refused([](Scene& s) { s.textures[0].rgba.pop_back(); }));
  EXPECT_TRUE(refused([](Scene& s) { s.skins[0].joints = {7}; }));
  EXPECT_TRUE(refused([](Scene& s) { s.animations[0].channels[0].values.pop_back(); }));
  EXPECT_TRUE(refused([](Scene& s) { s.meshes[0].positions[3].x = std::nanf(""); }));
}

}  // namespace
}  // namespace gloam
