// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Run time of volumes (PRT-7): voxels against their twin on the host, pixels against what can be worked out by hand.
#include "techniques/prt/prt_volume.h"

#include <gloam/bake.h>

#include <cmath>

#include "frame/test_frame.h"
#include "scene/environment.h"
#include "scene/transforms.h"
#include "techniques/prt/prt.h"
#include "techniques/prt/prt_bake_test_scenes.h"

namespace gloam::prt {
namespace {

constexpr int kSize = 64;
constexpr float kPi = 3.14159265f;

/// Even density in a box about the origin, whose voxels all see all of the light: J0 = L_0 y_0 / 4 pi and so on.
Volume evenVolume(float density, const glm::vec3& albedo) {
  Volume volume;
  volume.name = "haze";
  volume.size = {6, 5, 4};
  volume.bounds_min = {-1.5f, -1.25f, -1.0f};
  volume.bounds_max = {1.5f, 1.25f, 1.0f};
  volume.density.assign(volume.voxels(), density);
  volume.albedo = albedo;
  Transfer transfer;
  transfer.order = 3;
  transfer.direct.assign(volume.voxels() * 9, 0.0f);
  for (std::size_t v = 0; v < volume.voxels(); ++v) transfer.direct[v * 9] = std::sqrt(1.0f / (4.0f * kPi));
  volume.transfer = std::make_shared<Transfer>(transfer);
  return volume;
}

Environment evenSky(const glm::vec3& radiance) {
  Environment sky;
  sky.name = "even";
  sky.width = 16;
  sky.height = 8;
  sky.radiance.assign(128, radiance);
  return sky;
}

/// A baked wall at z, black, of the given half-width; the volume hangs on node 1.
Scene sceneWith(const Volume& volume, float wall_z, float half = 8.0f) {
  Scene scene;
  scene.materials.push_back({.base_color = {0, 0, 0, 1}, .metallic = 0.0f, .specular = 0.0f});
  addMesh(scene, gridMesh(half, 2)).name = "wall";
  scene.nodes[0].rotation = glm::angleAxis(0.5f * kPi, glm::vec3(1, 0, 0));
  scene.nodes[0].translation = {0, 0, wall_z};
  scene = bakeTransfer(scene, shadowed(3, 256));
  scene.nodes.emplace_back();
  scene.nodes[1].volume = std::make_shared<Volume>(volume);
  scene.roots.push_back(1);
  scene.environment = evenSky({1.0f, 0.5f, 0.25f});
  return scene;
}

struct Picture {
  std::vector<float> direct, indirect, voxels;
  Warnings warnings;
  glm::vec4 at(int x, int y) const {
    const std::size_t i = 4 * std::size_t(y * kSize + x);
    return {direct[i], direct[i + 1], direct[i + 2], direct[i + 3]};
  }
};

Picture draw(const Scene& scene, bool background = true, std::size_t chunk_bytes = 0,
             const PosedCamera& camera = frame::cameraAt({0, 0, 6.0f}, {0, 0, 0}, 40.0f)) {
  Settings settings(info().options);
  settings.set("window", "none");
  frame::TestFrame frame(scene);
  Prt technique(gpu::testDevice(), chunk_bytes);
  const frame::FrameImages images =
      frame.draw(pose(scene, 0.0f), camera, {.width = kSize, .height = kSize, .background = background},
                 [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                   return technique.record(graph, inputs, settings);
                 });
  Picture picture{
      images.direct.image().downloadFloats(), images.indirect.image().downloadFloats(), {}, frame.warnings};
  if (frame.graph.find("prt.volume_radiance_direct_0"))
    picture.voxels = frame.floats("prt.volume_radiance_direct_0");
  return picture;
}

TEST(PrtVolumeFrame, RadianceAlongARayIsTheLineIntegral) {
  const glm::vec3 light(1.0f, 0.5f, 0.25f), albedo(0.9f, 0.6f, 0.3f);
  for (const float density : {0.01f, 0.5f, 3.0f}) {
    const Picture picture = draw(sceneWith(evenVolume(density, albedo), -50.0f, 0.01f));
    const glm::vec4 seen = picture.at(kSize / 2, kSize / 2);
    const float left = std::exp(-density * 2.0f);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(seen[c], (1.0f - left) * albedo[c] * light[c] + left * light[c], 0.002f) << density;
    EXPECT_NEAR(picture.at(2, 2).x, 1.0f, 1e-3f);  // past the box
  }
}

TEST(PrtVolumeFrame, CoverageIsWhatTheVolumeHides) {
  const Picture picture = draw(sceneWith(evenVolume(0.5f, glm::vec3(0.9f)), -50.0f, 0.01f), false);
  EXPECT_NEAR(picture.at(kSize / 2, kSize / 2).w, 1.0f - std::exp(-1.0f), 0.003f);
  EXPECT_EQ(picture.at(2, 2).w, 0.0f);
}

TEST(PrtVolumeFrame, SurfacesCutTheWay) {
  const glm::vec3 light(1.0f, 0.5f, 0.25f);
  const auto expectLength = [&](float wall_z, float length) {
    const glm::vec4 seen =
        draw(sceneWith(evenVolume(0.5f, glm::vec3(0.8f)), wall_z)).at(kSize / 2, kSize / 2);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(seen[c], (1.0f - std::exp(-0.5f * length)) * 0.8f * light[c], 0.003f) << wall_z;
    EXPECT_EQ(seen.w, 1.0f);
  };
  expectLength(-3.0f, 2.0f);
  expectLength(0.25f, 0.75f);
  expectLength(1.5f, 0.0f);
}

TEST(PrtVolumeFrame, VoxelsAgreeWithTheHostWhileTheNodeTurns) {
  Volume volume = evenVolume(0.5f, {0.9f, 0.6f, 0.3f});
  auto transfer = std::make_shared<Transfer>(*volume.transfer);
  for (std::size_t i = 0; i < transfer->direct.size(); ++i)
    transfer->direct[i] += 0.05f * std::sin(float(i)) / (1.0f + float(i % 9));
  volume.transfer = transfer;
  Scene scene = sceneWith(volume, -3.0f);
  scene.nodes[1].rotation = glm::angleAxis(1.1f, glm::normalize(glm::vec3(1, 2, -1)));
  scene.nodes[1].scale = glm::vec3(0.7f);
  scene.environment = loadEnvironment("sky:mild?elevation=40");
  const sh::ShRgb light = sh::rotate(glm::transpose(glm::mat3_cast(scene.nodes[1].rotation)),
                                     projectEnvironment(scene.environment, 3));
  for (const std::size_t chunk_bytes : {std::size_t(0), std::size_t(1400)}) {  // whole, and block by block
    const Picture picture = draw(scene, true, chunk_bytes);
    ASSERT_EQ(picture.voxels.size(), 4 * volume.voxels());
    for (std::size_t v = 0; v < volume.voxels(); ++v) {
      glm::vec3 radiance(0.0f);
      for (int i = 0; i < 9; ++i) radiance += transfer->direct[v * 9 + std::size_t(i)] * light[i];
      radiance *= volume.albedo;
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(picture.voxels[4 * v + std::size_t(c)], radiance[c], 0.002f * radiance[c] + 1e-4f);
      EXPECT_NEAR(picture.voxels[4 * v + 3], 0.5f, 1e-3f);
    }
  }
}

TEST(PrtVolumeFrame, AScaledCloudIsAsDenseToLookAt) {
  Scene scene = sceneWith(evenVolume(0.5f, glm::vec3(0.8f)), -50.0f, 0.01f);
  const glm::vec4 seen = draw(scene).at(kSize / 2, kSize / 2);
  scene.nodes[1].scale = glm::vec3(0.5f);
  const glm::vec4 smaller = draw(scene).at(kSize / 2, kSize / 2);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], smaller[c], 0.002f);
}

TEST(PrtVolumeFrame, AWhiteCloudVanishesInAWhiteFurnace) {
  Volume volume = evenVolume(0.0f, glm::vec3(1.0f));
  volume.size = glm::ivec3(10);
  volume.bounds_min = glm::vec3(-1.0f);
  volume.bounds_max = glm::vec3(1.0f);
  volume.density.clear();
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 p = (glm::vec3(i % 10, i / 10 % 10, i / 100) + 0.5f) / 5.0f - 1.0f;
    volume.density.push_back(4.0f * std::max(0.0f, 1.0f - 1.5f * glm::dot(p, p)));
  }
  volume.transfer = nullptr;
  Scene scene = sceneWith(volume, -50.0f, 0.001f);
  scene.environment = evenSky(glm::vec3(1.0f));
  scene = bakeVolumes(scene, {.order = 3, .scatterings = 60, .directions = 128, .scatter_directions = 128});
  const Picture picture = draw(scene);
  for (std::size_t i = 0; i < picture.direct.size(); i += 4)
    EXPECT_NEAR(picture.direct[i] + picture.indirect[i], 1.0f, 0.006f);
}

TEST(PrtVolumeFrame, WhatIsNotBakedIsLeftOutAndSaid) {
  Volume volume = evenVolume(5.0f, glm::vec3(0.8f));
  volume.transfer = nullptr;
  const Picture picture = draw(sceneWith(volume, -3.0f));
  EXPECT_EQ(picture.at(kSize / 2, kSize / 2).x, 0.0f);
  ASSERT_EQ(picture.warnings.size(), 1u);
  EXPECT_NE(picture.warnings[0].find("1 of 1 volume left out"), std::string::npos) << picture.warnings[0];
}

TEST(PrtVolumeFrame, TransferThatDoesNotFitIsAnswered) {
  Volume volume = evenVolume(0.5f, glm::vec3(0.8f));
  auto transfer = std::make_shared<Transfer>(*volume.transfer);
  transfer->direct.pop_back();
  volume.transfer = transfer;
  EXPECT_THROW(draw(sceneWith(volume, -3.0f)), Error);
}

}  // namespace
}  // namespace gloam::prt
