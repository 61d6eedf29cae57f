// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/spherical_lights/spherical_lights_prepare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"
#include "trace/surface.h"

namespace gloam::spherical_lights {
namespace {

namespace fs = std::filesystem;

Scene sceneOf(std::vector<std::pair<Mesh, glm::vec3>> parts) {
  SceneBuilder builder("thing");
  std::vector<int> meshes;
  for (auto& [mesh, albedo] : parts)
    meshes.push_back(builder.mesh("part", std::move(mesh), builder.diffuse("colour", albedo)));
  const int node = builder.node("thing", kNone, {0, 0, 0});
  builder.at(node).meshes = meshes;
  return builder.finish();
}

SceneSpheres spheresOf(const Scene& scene, std::vector<Sphere> spheres) {
  SceneSpheres result;
  SphereSet& set = result.sets.emplace_back();
  set.name = "thing";
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) set.meshes.push_back(int(m));
  set.nodes = {0};
  set.geometry = std::string(32, '0');
  set.spheres = std::move(spheres);
  return result;
}

glm::vec3 placeOf(const Scene& scene, const EmissionSample& sample) {
  const Mesh& mesh = scene.meshes[std::size_t(sample.part)];
  return trace::interpolate(mesh, mesh.positions, {int(sample.triangle), sample.u, sample.v});
}

int senders(const SphereEmission& sphere) {
  return int(std::ranges::count_if(sphere.samples, [](const EmissionSample& s) { return s.part != kNone; }));
}

TEST(SphericalLightsPreparation, BallIsSeenFromWithinAllRound) {
  const Scene scene = sceneOf({{shapes::icosphere(1.0f, 12), glm::vec3(0.3f, 0.5f, 0.7f)}});
  const SceneEmission emission = sampleEmission(scene, spheresOf(scene, {{{0, 0, 0}, 1.0f}}));
  const SphereEmission& sphere = emission.sets.at(0).spheres.at(0);
  for (std::size_t j = 0; j < sphere.samples.size(); ++j) {
    ASSERT_EQ(sphere.samples[j].part, 0);
    EXPECT_EQ(sphere.samples[j].side, 1);
    const glm::vec3 place = placeOf(scene, sphere.samples[j]);
    EXPECT_LT(glm::distance(glm::normalize(place), emissionDirections()[j]), 1e-3f);
  }
  EXPECT_NEAR(sphere.albedo[0].y, 0.5f * sh::zonalFactor(0), 1e-4f);
  for (int i = 1; i < 16; ++i) EXPECT_NEAR(sphere.albedo[i].y, 0.0f, 1e-5f);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(sphere.glow[i], glm::vec3(0.0f));
  EXPECT_TRUE(emission.warnings.empty());
}

// Two balls in one another: each sends nothing to where only the other is met, and together they send from every point once.
TEST(SphericalLightsPreparation, SpheresSendFromTheirOwnSegmentAlone) {
  Mesh both = shapes::moved(shapes::icosphere(1.0f, 16), {-0.6f, 0, 0});
  shapes::append(both, shapes::moved(shapes::icosphere(1.0f, 16), {0.6f, 0, 0}));
  const Scene scene = sceneOf({{both, glm::vec3(0.5f)}});
  const SceneEmission emission =
      sampleEmission(scene, spheresOf(scene, {{{-0.6f, 0, 0}, 1.0f}, {{0.6f, 0, 0}, 1.0f}}));
  for (const float side : {-1.0f, 1.0f}) {
    const SphereEmission& sphere = emission.sets[0].spheres[side < 0.0f ? 0 : 1];
    EXPECT_GT(senders(sphere), 60);
    EXPECT_LT(senders(sphere), 92);
    for (std::size_t j = 0; j < sphere.samples.size(); ++j) {
      if (sphere.samples[j].part == kNone) {
        EXPECT_LT(emissionDirections()[j].x * side, -0.4f);
        continue;
      }
      EXPECT_GT(placeOf(scene, sphere.samples[j]).x * side, -1e-4f);
    }
  }
}

TEST(SphericalLightsPreparation, CentreOutsideTakesTheFrontOfTheOtherWay) {
  // A ball that its sphere's centre lies above: straight up nothing is met, so its top is what is seen from there.
  const Scene scene = sceneOf({{shapes::icosphere(0.5f, 16), glm::vec3(0.5f)}});
  const SceneEmission emission = sampleEmission(scene, spheresOf(scene, {{{0, 0.8f, 0}, 1.4f}}));
  const SphereEmission& sphere = emission.sets[0].spheres[0];
  int up = 0, down = 0;
  for (std::size_t j = 0; j < sphere.samples.size(); ++j) {
    if (sphere.samples[j].part == kNone) continue;
    const float y = placeOf(scene, sphere.samples[j]).y;
    (emissionDirections()[j].y > 0.0f ? up : down)++;
    EXPECT_EQ(emissionDirections()[j].y > 0.0f, y > 0.0f) << y;
  }
  EXPECT_GT(up, 5);
  EXPECT_EQ(up, down);
}

TEST(SphericalLightsPreparation, AlbedoIsThatOfEachSide) {
  const Scene scene =
      sceneOf({{shapes::moved(shapes::icosphere(1.0f, 8), {-3, 0, 0}), glm::vec3(0.8f, 0.1f, 0.1f)},
               {shapes::moved(shapes::icosphere(1.0f, 8), {3, 0, 0}), glm::vec3(0.1f, 0.1f, 0.8f)}});
  const SceneEmission emission = sampleEmission(scene, spheresOf(scene, {{{0, 0, 0}, 4.0f}}));
  const SphereEmission& sphere = emission.sets[0].spheres[0];
  EXPECT_GT(sh::valueAt(sphere.albedo, {1, 0, 0}).z, 2.0f * sh::valueAt(sphere.albedo, {1, 0, 0}).x);
  EXPECT_GT(sh::valueAt(sphere.albedo, {-1, 0, 0}).x, 2.0f * sh::valueAt(sphere.albedo, {-1, 0, 0}).z);
}

// A mirror sends light on as well; four bands cannot tell where to, so it counts as diffuse.
TEST(SphericalLightsPreparation, MetalSendsAsIfDiffuse) {
  Scene scene = sceneOf({{shapes::icosphere(1.0f, 8), glm::vec3(0.6f)}});
  scene.materials[0].metallic = 1.0f;
  const SceneEmission emission = sampleEmission(scene, spheresOf(scene, {{{0, 0, 0}, 1.0f}}));
  EXPECT_NEAR(emission.sets[0].spheres[0].albedo[0].x, 0.6f * sh::zonalFactor(0), 1e-3f);
}

TEST(SphericalLightsPreparation, InsideOutAndSheetsAreLitOutside) {
  Mesh ball = shapes::icosphere(1.0f, 8);
  for (std::size_t t = 0; t + 2 < ball.indices.size(); t += 3)
    std::swap(ball.indices[t], ball.indices[t + 1]);
  for (glm::vec3& n : ball.normals) n = -n;
  const Scene inverted = sceneOf({{ball, glm::vec3(0.5f)}});
  const SceneEmission emission = sampleEmission(inverted, spheresOf(inverted, {{{0, 0, 0}, 1.0f}}));
  EXPECT_EQ(senders(emission.sets[0].spheres[0]), 92);
  for (const EmissionSample& sample : emission.sets[0].spheres[0].samples) EXPECT_EQ(sample.side, -1);

  const std::vector<float> cells = shapes::steps(4);
  const Scene sheet =
      sceneOf({{shapes::patch({-1, 1, 0}, {2, 0, 0}, {0, -2, 0}, cells, cells), glm::vec3(0.5f)}});
  const SceneEmission flat = sampleEmission(sheet, spheresOf(sheet, {{{0, 0, -0.2f}, 1.5f}}));
  EXPECT_GT(senders(flat.sets[0].spheres[0]), 60);
  for (std::size_t j = 0; j < 92; ++j) {
    const EmissionSample& sample = flat.sets[0].spheres[0].samples[j];
    if (sample.part == kNone) continue;
    EXPECT_EQ(sample.side > 0, emissionDirections()[j].z > 0.0f);
  }
}

TEST(SphericalLightsPreparation, OptionsAndForeignSpheresAreRefused) {
  const Scene scene = sceneOf({{shapes::icosphere(1.0f, 4), glm::vec3(0.5f)}});
  SceneSpheres spheres = spheresOf(scene, {{{0, 0, 0}, 1.0f}});
  EXPECT_THROW(sampleEmission(scene, spheres, {.albedo_directions = 10}), Error);
  EXPECT_THROW(sampleEmission(scene, spheres, {}, {.should_stop = [] { return true; }}), Interrupted);
  spheres.sets[0].meshes = {5};
  EXPECT_THROW(sampleEmission(scene, spheres), Error);
}

TEST(SphericalLightsPreparation, DoesNotDependOnThreads) {
  const Scene scene = sceneOf({{shapes::icosphere(1.0f, 8), glm::vec3(0.5f, 0.4f, 0.3f)}});
  const SceneSpheres spheres = spheresOf(scene, {{{0, 0.2f, 0}, 1.0f}, {{0, -0.2f, 0}, 1.0f}});
  const fs::path folder = fs::temp_directory_path();
  writeEmission(sampleEmission(scene, spheres, {.threads = 1}), folder / "gloam_sl_one");
  writeEmission(sampleEmission(scene, spheres, {.threads = 3}), folder / "gloam_sl_three");
  const auto bytes = [](const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(bytes(folder / "gloam_sl_one"), bytes(folder / "gloam_sl_three"));
}

TEST(SphericalLightsPreparation, FilesComeBackAndBrokenOnesAreRefused) {
  const Scene scene = sceneOf({{shapes::icosphere(1.0f, 4), glm::vec3(0.5f, 0.4f, 0.3f)}});
  const SceneSpheres spheres = spheresOf(scene, {{{0, 0.2f, 0}, 1.0f}, {{0, -0.2f, 0}, 1.0f}});
  const SceneEmission emission = sampleEmission(scene, spheres);
  const fs::path file = fs::temp_directory_path() / "gloam_sl_test.emission";
  writeEmission(emission, file);
  const SceneEmission again = readEmission(file, scene, spheres);
  for (std::size_t s = 0; s < 2; ++s) {
    const SphereEmission &a = emission.sets[0].spheres[s], &b = again.sets[0].spheres[s];
    EXPECT_EQ(a.albedo.c, b.albedo.c);
    for (std::size_t j = 0; j < 92; ++j) {
      EXPECT_EQ(a.samples[j].triangle, b.samples[j].triangle);
      EXPECT_EQ(a.samples[j].u, b.samples[j].u);
    }
  }
  SceneSpheres others = spheres;
  others.sets[0].spheres[0].radius = 1.1f;
  EXPECT_THROW(readEmission(file, scene, others), Error);
  others.sets[0].spheres.pop_back();
  EXPECT_THROW(readEmission(file, scene, others), Error);
  EXPECT_THROW(readEmission(file.string() + ".none", scene, spheres), Error);
  {
    std::fstream damaged(file, std::ios::in | std::ios::out | std::ios::binary);
    damaged.seekp(200);
    damaged.put('x');
  }
  EXPECT_THROW(readEmission(file, scene, spheres), Error);
}

}  // namespace
}  // namespace gloam::spherical_lights
