// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Splitting opens no crack and makes no sliver; what is left of the error is below the bound.
#include <gloam/sh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <tuple>

#include "techniques/prt/prt_bake_test_scenes.h"
#include "techniques/prt/prt_tessellate_cut.h"
#include "techniques/prt/prt_tessellate_error.h"
#include "techniques/prt/prt_tessellate_split.h"

namespace gloam::prt {
namespace {

using Place = std::tuple<float, float, float>;

Place placeOf(const glm::vec3& p) {
  return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
}

/// How many triangles have each edge, told by the positions of its ends, over all meshes.
std::map<std::pair<Place, Place>, int> edgesOf(const Scene& scene) {
  std::map<std::pair<Place, Place>, int> edges;
  for (const Mesh& mesh : scene.meshes) {
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
      const Place a = placeOf(mesh.positions[mesh.indices[i]]),
                  b = placeOf(mesh.positions[mesh.indices[next]]);
      ++edges[{std::min(a, b), std::max(a, b)}];
    }
  }
  return edges;
}

float areaOf(const Scene& scene) {
  float area = 0.0f;
  for (const Mesh& mesh : scene.meshes) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const glm::vec3 &a = mesh.positions[mesh.indices[i]], &b = mesh.positions[mesh.indices[i + 1]],
                      &c = mesh.positions[mesh.indices[i + 2]];
      area += 0.5f * glm::length(glm::cross(b - a, c - a));
    }
  }
  return area;
}

float leastAngle(const Scene& scene) {
  float least = 3.0f;
  for (const Mesh& mesh : scene.meshes) {
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      const std::size_t t = i / 3 * 3;
      const glm::vec3 &a = mesh.positions[mesh.indices[i]],
                      &b = mesh.positions[mesh.indices[t + (i + 1) % 3]],
                      &c = mesh.positions[mesh.indices[t + (i + 2) % 3]];
      least = std::min(least, std::acos(glm::dot(glm::normalize(b - a), glm::normalize(c - a))));
    }
  }
  return least;
}

/// Splits a third of all triangles, again and again.
void splitAtRandom(Scene& scene, int passes, std::size_t max_vertices = 1u << 20) {
  std::mt19937 random(11);
  SplitMesh mesh(scene, pose(scene, 0.0f));
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<TriangleRef> chosen;
    for (std::uint32_t i = 0; i < scene.meshes.size(); ++i) {
      for (std::uint32_t t = 0; t < scene.meshes[i].triangleCount(); ++t) {
        if (random() % 3 == 0) chosen.push_back({i, t});
      }
    }
    mesh.split(chosen, max_vertices);
  }
}

// A closed surface whose corners are three vertices each: each edge stands between two triangles, before and after.
TEST(PrtTessellate, NoCrackOpens) {
  Scene scene = sceneOf(boxMesh({1.0f, 0.4f, 0.7f}, false));
  for (const auto& [edge, count] : edgesOf(scene)) ASSERT_EQ(count, 2);
  const float area = areaOf(scene), angle = leastAngle(scene);
  const std::size_t before = scene.meshes[0].triangleCount();
  splitAtRandom(scene, 4);
  EXPECT_GT(scene.meshes[0].triangleCount(), 4 * before);
  for (const auto& [edge, count] : edgesOf(scene)) ASSERT_EQ(count, 2);
  EXPECT_NEAR(areaOf(scene), area, 1e-4f * area);
  EXPECT_GT(leastAngle(scene), 0.49f * angle)
      << "Rosenberg and Stenger 1975: bisection halves no angle twice";
}

// Two floors side by side, each a mesh of its own, one of them placed by its node; and a corner with two normals.
TEST(PrtTessellate, NeighbouringMeshesAreSplitAlike) {
  Scene scene = sceneOf(quadMesh({0, 0, 0}, {0, 0, 1}, {1, 0, 0}));
  addMesh(scene, quadMesh({0, 0, 0}, {0, 0, 1}, {1, 0, 0}));
  scene.nodes[1].translation = {2, 0, 0};
  addMesh(scene, quadMesh({-1, 1, 0}, {0, 1, 0}, {0, 0, 1}));
  splitAtRandom(scene, 6);
  const auto along = [&](std::size_t mesh, float x) {
    std::vector<float> places;
    for (const glm::vec3& p : scene.meshes[mesh].positions) {
      if (p.x == x && p.y == 0.0f) places.push_back(p.z);
    }
    std::ranges::sort(places);
    return places;
  };
  EXPECT_GT(along(0, 1.0f).size(), 3u);
  EXPECT_EQ(along(0, 1.0f), along(1, -1.0f));
  EXPECT_EQ(along(0, -1.0f), along(2, -1.0f));
}

// A box sunk into a floor and one that stands upon it: afterwards no edge goes from the open into either, and no crack opens.
TEST(PrtTessellate, EdgesAreCutWhereBodiesMeet) {
  for (const float height : {0.02f, 0.15f}) {
    Scene scene = sceneOf(gridMesh(1.0f, 12));
    addMesh(scene, boxMesh({0.3f, 0.15f, 0.2f}, false));
    scene.nodes[1].translation = {0.013f, height, 0.027f};
    const Scene whole = scene;
    const PosedScene posed = pose(whole, 0.0f);
    const trace::Tracer tracer(whole, posed);
    SplitMesh mesh(scene, pose(scene, 0.0f));
    const float area = areaOf(scene);
    for (int k = 0; k < 3; ++k) mesh.cut(crossingsWith(tracer, whole, posed), {0.0, 10.0}, 1u << 20);
    EXPECT_NEAR(areaOf(scene), area, 1e-4f * area);
    const auto beyond = [&](const glm::vec3& p) {  // metres outside the box's outline
      return std::max(std::abs(p.x - 0.013f) - 0.3f, std::abs(p.z - 0.027f) - 0.2f);
    };
    std::size_t on_outline = 0;
    for (const glm::vec3& p : scene.meshes[0].positions) on_outline += std::abs(beyond(p)) < 1e-3f;
    EXPECT_GT(on_outline, 20u);
    const Mesh& floor = scene.meshes[0];
    for (std::size_t i = 0; i < floor.indices.size(); ++i) {
      const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
      const float a = beyond(floor.positions[floor.indices[i]]),
                  b = beyond(floor.positions[floor.indices[next]]);
      EXPECT_FALSE(std::max(a, b) > 0.01f && std::min(a, b) < -0.01f) << a << " " << b;
    }
    for (const auto& [edge, count] : edgesOf(scene)) ASSERT_LE(count, 2);
  }
}

TEST(PrtTessellate, AllOfAVertexIsInterpolated) {
  Scene scene = sceneOf(gridMesh(1.0f, 2));
  Mesh& mesh = scene.meshes[0];
  mesh.uv_sets.resize(2);
  for (const glm::vec3& p : mesh.positions) {
    mesh.tangents.emplace_back(1, 0, 0, 1);
    mesh.uv_sets[0].emplace_back(p.x, 2 * p.z);
    mesh.uv_sets[1].emplace_back(0.5f * p.z, 0.25f);
    mesh.colors.emplace_back(p.x, p.z, 0, 1);
  }
  splitAtRandom(scene, 5);
  ASSERT_GT(mesh.vertexCount(), 40u);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const glm::vec3& p = mesh.positions[v];
    EXPECT_EQ(mesh.normals[v], glm::vec3(0, 1, 0));
    EXPECT_EQ(mesh.tangents[v], glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(mesh.uv_sets[0][v], glm::vec2(p.x, 2 * p.z));
    EXPECT_EQ(mesh.uv_sets[1][v], glm::vec2(0.5f * p.z, 0.25f));
    EXPECT_EQ(mesh.colors[v], glm::vec4(p.x, p.z, 0, 1));
  }
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::vec3 &a = mesh.positions[mesh.indices[i]], &b = mesh.positions[mesh.indices[i + 1]],
                    &c = mesh.positions[mesh.indices[i + 2]];
    EXPECT_GT(glm::cross(b - a, c - a).y, 0.0f);
  }
}

TEST(PrtTessellate, StopsAtTheMostVertices) {
  for (const std::size_t most : {30u, 200u}) {
    Scene scene = sceneOf(gridMesh(1.0f, 2));
    splitAtRandom(scene, 8, most);
    EXPECT_LE(scene.meshes[0].vertexCount(), most);
    EXPECT_GT(scene.meshes[0].vertexCount(), most * 3 / 4);
  }
}

/// A floor of two triangles with a plate floating above.
Scene plateScene() {
  Scene scene = sceneOf(quadMesh({0, 0, 0}, {0, 0, 4}, {4, 0, 0}));
  Mesh plate = boxMesh(glm::vec3(0.8f, 0.05f, 0.5f), false);
  for (glm::vec3& p : plate.positions) p += glm::vec3(1.1f, 0.6f, -0.7f);
  addMesh(scene, plate);
  return scene;
}

/// Greatest and root mean square error of the floor's DS against that of a fine grid, as a share of open light.
glm::dvec2 floorError(const Scene& scene) {
  constexpr int kCells = 48;
  Scene fine = plateScene();
  fine.meshes[0] = gridMesh(4.0f, kCells);
  const Scene truth = bakeTransfer(fine, shadowed(4, 2048)), baked = bakeTransfer(scene, shadowed(4, 2048));
  const Mesh &grid = truth.meshes[0], &floor = baked.meshes[0];
  double open = 0.0;
  for (const float c : sh::rotateZonal(sh::clampedCosine(4), {0, 1, 0}).coefficients()) open += double(c * c);
  open = std::sqrt(open);
  double most = 0.0, sum = 0.0;
  for (std::size_t v = 0; v < grid.vertexCount(); ++v) {
    const glm::vec3& p = grid.positions[v];
    double least_outside = 1e9, squared = 0.0;
    for (std::size_t i = 0; i < floor.indices.size(); i += 3) {
      const std::uint32_t* c = &floor.indices[i];
      const glm::vec2 a(floor.positions[c[0]].x, floor.positions[c[0]].z),
          b(floor.positions[c[1]].x, floor.positions[c[1]].z),
          d(floor.positions[c[2]].x, floor.positions[c[2]].z), q(p.x, p.z);
      const float area = (b.x - a.x) * (d.y - a.y) - (b.y - a.y) * (d.x - a.x);
      const float u = ((q.x - a.x) * (d.y - a.y) - (q.y - a.y) * (d.x - a.x)) / area,
                  w = ((b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x)) / area;
      const double outside = std::max({0.0f, -u, -w, u + w - 1.0f});
      if (outside >= least_outside) continue;
      least_outside = outside;
      squared = 0.0;
      for (std::size_t k = 0; k < 16; ++k) {
        const auto at = [&](std::uint32_t vertex) { return floor.transfer->direct[vertex * 16 + k]; };
        const float value = (1 - u - w) * at(c[0]) + u * at(c[1]) + w * at(c[2]);
        squared += std::pow(double(value - grid.transfer->direct[v * 16 + k]), 2.0);
      }
    }
    most = std::max(most, std::sqrt(squared) / open);
    sum += squared;
  }
  return {most, std::sqrt(sum / double(grid.vertexCount())) / open};
}

TEST(PrtTessellate, ErrorEndsBelowTheBound) {
  const Scene scene = plateScene();
  TessellateOptions options;
  options.error = 0.06f;
  options.order = 4;
  TessellateReport report;
  const Scene split = tessellateForTransfer(scene, options, {}, &report);
  EXPECT_GT(report.error_before, 0.2);
  EXPECT_LE(report.error_after, 0.06);
  EXPECT_EQ(report.above, 0u);
  EXPECT_EQ(report.above_area, 0.0);
  EXPECT_LT(report.mean_error_before, report.error_before);
  EXPECT_LT(report.mean_error_after, 0.5 * report.mean_error_before);
  EXPECT_EQ(report.vertices_before, scene.meshes[0].vertexCount() + scene.meshes[1].vertexCount());
  EXPECT_EQ(report.vertices_after, split.meshes[0].vertexCount() + split.meshes[1].vertexCount());
  EXPECT_LT(split.meshes[0].vertexCount(), 1500u);
  EXPECT_EQ(split.meshes[1].vertexCount(), scene.meshes[1].vertexCount()) << "nothing falls on the plate";
  const glm::dvec2 before = floorError(scene), after = floorError(split);
  EXPECT_LT(after.x, 1.5 * 0.06) << "against a fine grid";
  EXPECT_LT(after.y, 0.25 * before.y);
}

TEST(PrtTessellate, SameMeshForAnyNumberOfThreads) {
  TessellateOptions options;
  options.error = 0.1f;
  options.order = 3;
  options.max_vertices = 60;
  std::vector<Scene> scenes;
  for (const int threads : {1, 3}) {
    options.threads = threads;
    TessellateReport report;
    scenes.push_back(tessellateForTransfer(plateScene(), options, {}, &report));
    EXPECT_LE(report.vertices_after, 60u);
    EXPECT_GT(report.above, 0u);
  }
  EXPECT_EQ(scenes[0].meshes[0].positions, scenes[1].meshes[0].positions);
  EXPECT_EQ(scenes[0].meshes[0].indices, scenes[1].meshes[0].indices);
}

// A box that stands on the floor: at its foot light ends at once, and no triangle is small enough.
TEST(PrtTessellate, EdgesOfLightEndAtTheFinest) {
  Scene scene = sceneOf(quadMesh({0, 0, 0}, {0, 0, 2}, {2, 0, 0}));
  Mesh box = boxMesh(glm::vec3(0.4f), false);
  for (glm::vec3& p : box.positions) p += glm::vec3(0.2f, 0.39f, 0.1f);
  addMesh(scene, box);
  TessellateOptions options;
  options.error = 0.1f;
  options.order = 3;
  options.directions = 256;
  TessellateReport report;
  tessellateForTransfer(scene, options, {}, &report);
  EXPECT_EQ(report.above, report.at_finest);
  EXPECT_GT(report.at_finest, 0u);
  EXPECT_GT(report.error_after, 0.1);
  EXPECT_LT(report.mean_error_after, 0.1) << "of all but a narrow band";
  EXPECT_GT(report.above_area, 0.0);
  EXPECT_LT(report.above_area, 0.02);
  EXPECT_LT(report.vertices_after, 5000u) << "vertices there lower no error";
  EXPECT_FALSE(report.out_of_rays);
  EXPECT_GT(report.rays, 0u);
}

// Time is bounded by rays, on any machine alike.
TEST(PrtTessellate, StopsAtTheMostRays) {
  TessellateOptions options;
  options.error = 0.03f;
  TessellateReport all, some;
  tessellateForTransfer(plateScene(), options, {}, &all);
  ASSERT_FALSE(all.out_of_rays);
  options.max_rays = 2000000;
  std::vector<Scene> scenes;
  for (const int threads : {1, 3}) {
    options.threads = threads;
    scenes.push_back(tessellateForTransfer(plateScene(), options, {}, &some));
    EXPECT_TRUE(some.out_of_rays);
    EXPECT_LT(some.rays, all.rays);
    EXPECT_LT(some.rays, 3 * options.max_rays);
    EXPECT_LT(some.vertices_after, all.vertices_after);
  }
  EXPECT_EQ(scenes[0].meshes[0].positions, scenes[1].meshes[0].positions);
}

TEST(PrtTessellate, RefusesWhatItCannotDo) {
  const Scene scene = plateScene();
  EXPECT_THROW(tessellateForTransfer(scene, {.error = 0.0f}), Error);
  EXPECT_THROW(tessellateForTransfer(scene, {.error = NAN}), Error);
  EXPECT_THROW(tessellateForTransfer(scene, {.order = 7}), Error);
  EXPECT_THROW(tessellateForTransfer(scene, {.directions = 10}), Error);
  EXPECT_THROW(tessellateForTransfer(scene, {.max_rays = 10}), Error);
  EXPECT_THROW(tessellateForTransfer(Scene{}, {}), Error);
  Progress progress;
  progress.should_stop = [] { return true; };
  EXPECT_THROW(tessellateForTransfer(scene, {}, progress), Interrupted);
}

}  // namespace
}  // namespace gloam::prt
