// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Laws of light in volumes, and a slow twin: photons that wander by delta tracking.
#include <gloam/sh.h>
#include <gloam/volume.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "math/sampling.h"
#include "techniques/prt/prt_bake_test_scenes.h"
#include "techniques/prt/prt_volume_march.h"

namespace gloam::prt {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A ball that thins out toward its rim, in a box of 2 metres.
Volume blob(int side, float density, float albedo, float g = 0.0f) {
  Volume volume;
  volume.size = glm::ivec3(side);
  volume.bounds_min = glm::vec3(-1.0f);
  volume.albedo = glm::vec3(albedo);
  volume.asymmetry = g;
  for (int i = 0; i < side * side * side; ++i) {
    const glm::vec3 p =
        (glm::vec3(i % side, i / side % side, i / (side * side)) + 0.5f) * (2.0f / float(side)) - 1.0f;
    volume.density.push_back(density * std::max(0.0f, 1.0f - 1.6f * glm::dot(p, p)));
  }
  return volume;
}

Scene sceneOf(Volume volume) {
  Scene scene;
  scene.nodes.resize(1);
  scene.nodes[0].name = "smoke";
  scene.nodes[0].volume = std::make_shared<Volume>(std::move(volume));
  scene.roots = {0};
  return scene;
}

Volume baked(const Volume& volume, int scatterings, int directions = 256) {
  const Scene scene = bakeVolumes(
      sceneOf(volume),
      {.order = 3, .scatterings = scatterings, .directions = directions, .scatter_directions = directions});
  return *scene.nodes[0].volume;
}

/// Radiance, mean over all directions, that light of these coefficients makes at a voxel.
double radianceOf(const Volume& volume, std::size_t voxel, const sh::Sh& light, int color = 0) {
  const Transfer& transfer = *volume.transfer;
  const std::size_t n = std::size_t(transfer.order * transfer.order);
  double sum = 0.0;
  for (std::size_t i = 0; i < std::min<std::size_t>(n, std::size_t(light.size())); ++i) {
    double m = double(transfer.direct[voxel * n + i]);
    if (!transfer.indirect.empty()) m += double(transfer.indirect[(voxel * n + i) * 3 + std::size_t(color)]);
    sum += m * double(light[int(i)]);
  }
  return sum;
}

sh::Sh evenLight() {
  sh::Sh light(3);
  light[0] = float(std::sqrt(4.0 * kPi));
  return light;
}

TEST(PrtVolume, AnEvenSlabLetsThroughWhatItsThicknessSays) {
  Volume volume;
  volume.size = {8, 16, 8};
  volume.bounds_min = {-1, -2, -1};
  volume.bounds_max = {1, 2, 1};
  volume.density.assign(volume.voxels(), 0.7f);
  const VolumeMarcher marcher(volume, 1.0f);
  EXPECT_EQ(marcher.filled().size(), volume.voxels());
  for (const std::uint32_t voxel : {0u, 500u, 1023u}) {
    const glm::vec3 at = marcher.position(voxel);
    EXPECT_NEAR(marcher.opticalDepth(voxel, {0, 1, 0}), 0.7f * (2.0f - at.y), 1e-4f);
    EXPECT_NEAR(marcher.opticalDepth(voxel, {-1, 0, 0}), 0.7f * (at.x + 1.0f), 1e-4f);
    const glm::vec3 slanted = glm::normalize(glm::vec3(1, 1, 1));
    const float way = std::min({1.0f - at.x, 2.0f - at.y, 1.0f - at.z}) * std::sqrt(3.0f);
    EXPECT_NEAR(marcher.opticalDepth(voxel, slanted), 0.7f * way, 1e-4f);
    std::vector<Gathered> gathered;
    marcher.gather(voxel, slanted, gathered);
    double sum = 0.0;
    for (const Gathered& share : gathered) sum += double(share.weight);
    EXPECT_NEAR(sum, 1.0 - std::exp(-0.7 * double(way)), 1e-5);
  }
}

TEST(PrtVolume, AWhiteVolumeInAWhiteFurnaceTendsToOne) {
  const Volume volume = blob(10, 3.0f, 1.0f);
  double before = 0.0;
  for (const int scatterings : {1, 4, 40}) {
    const Volume lit = baked(volume, scatterings, 128);
    double least = 1e9, most = 0.0;
    for (std::size_t v = 0; v < lit.voxels(); ++v) {
      if (lit.density[v] <= 0.0f) continue;
      const double radiance = radianceOf(lit, v, evenLight());
      least = std::min(least, radiance);
      most = std::max(most, radiance);
    }
    EXPECT_GT(least, before);
    EXPECT_LT(most, 1.0005);
    before = least;
  }
  EXPECT_GT(before, 0.999);
}

TEST(PrtVolume, AThinVolumeReceivesAllLight) {
  const Volume lit = baked(blob(8, 1e-4f, 0.9f), 1);
  for (std::size_t v = 0; v < lit.voxels(); ++v)
    if (lit.density[v] > 0.0f) {
      EXPECT_NEAR(radianceOf(lit, v, evenLight()), 1.0, 1e-3);
    }
}

TEST(PrtVolume, SimilarityKeepsAbsorption) {
  Volume volume = blob(4, 2.0f, 0.9f, 0.6f);
  const EvenMedium even = evenMedium(volume);
  EXPECT_NEAR(even.extinction * (1.0f - even.albedo.x), 0.1f, 1e-6f);
  EXPECT_NEAR(even.extinction * even.albedo.x, 0.9f * 0.4f, 1e-6f);
  volume.asymmetry = 0.0f;
  EXPECT_EQ(evenMedium(volume).extinction, 1.0f);
  EXPECT_NEAR(evenMedium(volume).albedo.x, 0.9f, 1e-6f);
}

glm::vec3 turned(const glm::vec3& direction, float g, sampling::Rng& rng) {
  const glm::vec2 u = rng.next2();
  float cosine = 1.0f - 2.0f * u.x;
  if (std::abs(g) > 1e-3f) {  // Henyey and Greenstein's
    const float s = (1.0f - g * g) / (1.0f - g + 2.0f * g * u.x);
    cosine = (1.0f + g * g - s * s) / (2.0f * g);
  }
  const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)), phi = float(2.0 * kPi) * u.y;
  const glm::vec3 helper = std::abs(direction.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 right = glm::normalize(glm::cross(helper, direction)), up = glm::cross(direction, right);
  return glm::normalize(cosine * direction + sine * (std::cos(phi) * right + std::sin(phi) * up));
}

struct Estimate {
  double mean = 0.0, error = 0.0;
};

/// Mean radiance at a place under light 1 + 0.9 y, of photons that are followed back, `scatterings` orders.
Estimate wander(const Volume& volume, const glm::vec3& place, int scatterings, int count) {
  const VolumeMarcher marcher(volume, 1.0f);
  const float majorant = *std::ranges::max_element(volume.density);
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < count; ++i) {
    sampling::Rng rng(7, std::uint32_t(i));
    glm::vec3 at = place, direction = sampling::uniformSphere(rng.next2());
    double weight = 1.0, value = 0.0;
    for (int scattered = 0; scattered < scatterings;) {
      at -= direction * (std::log(1.0f - rng.next()) / majorant);
      if (glm::any(glm::greaterThan(glm::abs(at), glm::vec3(1.0f)))) {
        value = weight * (1.0 + 0.9 * double(direction.y));
        break;
      }
      if (rng.next() * majorant >= marcher.densityAt(at)) continue;
      weight *= double(volume.albedo.x);
      direction = turned(direction, volume.asymmetry, rng);
      ++scattered;
    }
    sum += value;
    squares += value * value;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / count)};
}

void expectTwin(const Volume& volume, int scatterings, int twin_scatterings, double tolerance) {
  const Volume lit = baked(volume, scatterings);
  sh::Sh light = evenLight();
  light[1] = float(0.9 * std::sqrt(4.0 * kPi / 3.0));
  const VolumeMarcher marcher(volume, 1.0f);
  const std::size_t side = std::size_t(volume.size.x);
  for (const std::size_t y : {side / 4, side / 2, 3 * side / 4}) {
    const std::size_t voxel = side / 2 + side * (y + side * (side / 2 - 1));
    const Estimate twin = wander(volume, marcher.position(std::uint32_t(voxel)), twin_scatterings, 60000);
    EXPECT_NEAR(radianceOf(lit, voxel, light), twin.mean, 4.0 * twin.error + tolerance * twin.mean)
        << "voxel " << voxel;
  }
}

TEST(PrtVolume, WanderingPhotonsFindTheSameLight) {
  expectTwin(blob(16, 4.0f, 0.9f), 1, 1, 0.01);
  expectTwin(blob(16, 4.0f, 0.9f), 12, 12, 0.01);
}

TEST(PrtVolume, PhotonsThatGoAheadFindNearlyTheSameLight) {
  expectTwin(blob(12, 8.0f, 0.95f, 0.6f), 24, 200, 0.08);
}

TEST(PrtVolume, AFloorTakesTheLightBelowIt) {
  Scene scene = sceneOf(blob(6, 1e-4f, 0.9f));
  addMesh(scene, gridMesh(1000.0f, 2));
  scene.nodes[0].translation = {0, 1.5f, 0};
  scene.nodes[0].rotation = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 2, 3)));
  const Scene lit = bakeVolumes(scene, {.order = 3, .scatterings = 1, .directions = 4096});
  for (std::size_t v = 0; v < 216; ++v)
    if (lit.nodes[0].volume->density[v] > 0.0f) {
      EXPECT_NEAR(radianceOf(*lit.nodes[0].volume, v, evenLight()), 0.5, 2e-3);
    }
}

TEST(PrtVolume, SameBitsForAnyNumberOfThreads) {
  const Scene scene = sceneOf(blob(10, 5.0f, 0.9f));
  const auto bits = [&](int threads) {
    return *bakeVolumes(scene, {.order = 3,
                                .scatterings = 3,
                                .directions = 64,
                                .scatter_directions = 32,
                                .threads = threads})
                .nodes[0]
                .volume->transfer;
  };
  const Transfer one = bits(1), three = bits(3);
  EXPECT_EQ(one.direct, three.direct);
  EXPECT_EQ(one.indirect, three.indirect);
}

TEST(PrtVolume, SameBitsAfterInterruptions) {
  Scene scene = sceneOf(blob(10, 5.0f, 0.9f));
  scene.nodes.push_back(scene.nodes[0]);
  scene.nodes[1].volume = std::make_shared<Volume>(blob(8, 2.0f, 0.7f));
  scene.roots.push_back(1);
  VolumeBakeOptions options = {.order = 3, .scatterings = 4, .directions = 64, .scatter_directions = 32};
  const Scene whole = bakeVolumes(scene, options);
  options.checkpoint = std::filesystem::path(testing::TempDir()) / "volumes.ckp";
  std::filesystem::remove(options.checkpoint);
  for (int interruptions = 0;; ++interruptions) {
    ASSERT_LT(interruptions, 1000);
    int asked = 0;
    Progress progress;  // some blocks at a time
    progress.should_stop = [&] { return ++asked > 7; };
    try {
      VolumeReport report;
      const Scene pieces = bakeVolumes(scene, options, progress, &report);
      EXPECT_GT(interruptions, 3);
      EXPECT_TRUE(report.resumed);
      for (int node : {0, 1}) {
        const Transfer &one = *whole.nodes[std::size_t(node)].volume->transfer,
                       &other = *pieces.nodes[std::size_t(node)].volume->transfer;
        EXPECT_EQ(one.direct, other.direct);
        EXPECT_EQ(one.indirect, other.indirect);
      }
      break;
    } catch (const Interrupted&) {
      EXPECT_TRUE(std::filesystem::exists(options.checkpoint));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(options.checkpoint));
  options.keep_checkpoint = true;
  bakeVolumes(scene, options);
  options.scatterings = 5;
  EXPECT_THROW(bakeVolumes(scene, options), Error);  // that of other options
  EXPECT_TRUE(std::filesystem::exists(options.checkpoint));
  std::filesystem::remove(options.checkpoint);
}

TEST(PrtVolume, ColoursScatterByTheirOwnAlbedo) {
  Volume volume = blob(8, 5.0f, 0.9f);
  volume.albedo = {0.9f, 0.5f, 0.0f};
  const Volume colored = baked(volume, 6, 64);
  volume.albedo = glm::vec3(0.5f);
  const Volume grey = baked(volume, 6, 64);
  const std::size_t middle = 4 + 8 * (4 + 8 * 4);
  EXPECT_NEAR(radianceOf(colored, middle, evenLight(), 1), radianceOf(grey, middle, evenLight()), 1e-5);
  EXPECT_GT(radianceOf(colored, middle, evenLight(), 0), 1.2 * radianceOf(colored, middle, evenLight(), 2));
}

TEST(PrtVolume, TellsWhatItTakesStopsAndRefuses) {
  const Scene scene = sceneOf(blob(16, 5.0f, 0.9f));
  const VolumeEstimate estimate = estimateVolumes(scene, {.order = 4});
  EXPECT_EQ(estimate.voxels, 4096u);
  EXPECT_GT(estimate.filled, 1000u);
  EXPECT_LT(estimate.filled, 4096u);
  EXPECT_EQ(estimate.file_bytes, 4096u * 65u * 4u);
  EXPECT_THROW(bakeVolumes(scene, {.memory_bytes = 1000}), Error);
  EXPECT_THROW(bakeVolumes(scene, {.order = 2}), Error);
  EXPECT_THROW(bakeVolumes(scene, {.scatterings = 0}), Error);
  EXPECT_THROW(bakeVolumes(scene, {.directions = 1}), Error);
  Progress stop;
  stop.should_stop = [] { return true; };
  EXPECT_THROW(bakeVolumes(scene, {}, stop), Interrupted);
  Volume broken = blob(4, 1.0f, 0.9f);
  broken.density.pop_back();
  EXPECT_THROW(bakeVolumes(sceneOf(broken), {}), Error);
}

}  // namespace
}  // namespace gloam::prt
