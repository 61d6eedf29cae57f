// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/bake.h>
#include <gloam/compress.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "techniques/prt/prt_bake_test_scenes.h"
#include "techniques/prt/prt_compress.h"

namespace gloam::prt {
namespace {

/// Points near `spaces` planes of two dimensions, far apart, in a space of ten.
std::vector<float> pointsNearPlanes(int spaces, int each, float noise) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  std::vector<float> values;
  for (int s = 0; s < spaces; ++s) {
    float frame[3][10];
    for (auto& row : frame) {
      for (float& v : row) v = normal(random);
    }
    for (int p = 0; p < each; ++p) {
      const float a = normal(random), b = normal(random);
      for (int i = 0; i < 10; ++i)
        values.push_back(20.0f * frame[0][i] + a * frame[1][i] + b * frame[2][i] + noise * normal(random));
    }
  }
  return values;
}

double relativeError(const std::vector<float>& values, const ClusteredPca& pca, std::size_t width,
                     std::size_t vectors) {
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t p = i / width, d = i % width, c = pca.cluster[p];
    double sum = double(pca.means[c * width + d]);
    for (std::size_t m = 0; m < vectors; ++m)
      sum += double(pca.weights[p * vectors + m]) * double(pca.basis[(c * vectors + m) * width + d]);
    error += (sum - double(values[i])) * (sum - double(values[i]));
    size += double(values[i]) * double(values[i]);
  }
  return std::sqrt(error / size);
}

TEST(ClusteredPca, FindsSpacesThatAreThere) {
  const std::vector<float> values = pointsNearPlanes(4, 300, 0.0f);
  EXPECT_LT(relativeError(values, clusteredPca(values, 10, 4, 2, 20), 10, 2), 1e-5);
  EXPECT_GT(relativeError(values, clusteredPca(values, 10, 4, 1, 20), 10, 1), 1e-3);
}

TEST(ClusteredPca, MoreOfEitherErrsLess) {
  const std::vector<float> values = pointsNearPlanes(6, 200, 0.5f);
  double last = 1.0;
  for (const int vectors : {0, 1, 2, 4, 8}) {
    const double error =
        relativeError(values, clusteredPca(values, 10, 6, vectors, 20), 10, std::size_t(vectors));
    EXPECT_LT(error, last);
    last = error;
  }
  EXPECT_LT(relativeError(values, clusteredPca(values, 10, 6, 10, 20), 10, 10), 1e-5);  // all there is
}

TEST(ClusteredPca, OnePointAndManyAlikeAreNoTrouble) {
  const std::vector<float> one = {1, 2, 3};
  EXPECT_LT(relativeError(one, clusteredPca(one, 3, 1, 2, 5), 3, 2), 1e-6);
  std::vector<float> alike;
  for (int i = 0; i < 100; ++i) alike.insert(alike.end(), {3, 2, 1});
  EXPECT_LT(relativeError(alike, clusteredPca(alike, 3, 4, 2, 5), 3, 2), 1e-6);
}

TEST(ClusteredPca, SameBitsForAnyNumberOfThreads) {
  const std::vector<float> values = pointsNearPlanes(5, 700, 0.3f);
  const auto withThreads = [&](std::size_t count) {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, count);
    return clusteredPca(values, 10, 7, 3, 10);
  };
  const ClusteredPca one = withThreads(1), four = withThreads(4);
  EXPECT_EQ(one.means, four.means);
  EXPECT_EQ(one.basis, four.basis);
  EXPECT_EQ(one.weights, four.weights);
  EXPECT_EQ(one.cluster, four.cluster);
}

/// A box over a floor; every vertex is a triangle's, so that all come back from a file.
Scene boxScene() {
  Scene scene = sceneOf(gridMesh(1.0f, 16));
  Mesh box = boxMesh(glm::vec3(0.3f), false);
  for (glm::vec3& p : box.positions) p.y += 0.4f;
  addMesh(scene, box);
  return scene;
}

Scene baked(int bounces) {
  return bakeTransfer(boxScene(),
                      {.kind = bounces > 0 ? TransferKind::kInterreflected : TransferKind::kShadowed,
                       .order = 4,
                       .bounces = std::max(bounces, 1),
                       .directions = 256,
                       .bounce_directions = 256});
}

TEST(CompressTransfer, ErrorsAreThoseOfWhatComesBackFromTheFile) {
  for (const bool half_float : {false, true}) {
    const Scene scene = baked(1);
    CompressReport report;
    const Scene small =
        compressTransfer(scene, {.clusters = 4, .vectors = 8, .half_float = half_float}, {}, &report);
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "gloam_compress_test.glb";
    writeGlb(small, path, {.half_float = half_float});
    const Scene again = loadScene(path.string());
    std::filesystem::remove(path);
    double error = 0.0, size = 0.0;
    ASSERT_EQ(again.meshes.size(), small.meshes.size());
    for (const Scene* s : {&small, &again}) {
      EXPECT_EQ(s->meshes[0].transfer->compressed->of, s->meshes[1].transfer->compressed->of)
          << "clusters are shared";
    }
    for (std::size_t m = 0; m < small.meshes.size(); ++m) {
      const Transfer &was = *scene.meshes[m].transfer, &is = *again.meshes[m].transfer;
      ASSERT_TRUE(is.compressed);
      EXPECT_EQ(is.direct, small.meshes[m].transfer->direct);
      EXPECT_EQ(is.indirect, small.meshes[m].transfer->indirect);
      const auto add = [&](const std::vector<float>& a, const std::vector<float>& b, double weight) {
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
          error += weight * double(a[i] - b[i]) * double(a[i] - b[i]);
          size += weight * double(a[i]) * double(a[i]);
        }
      };
      add(was.direct, is.direct, 3.0);
      add(was.indirect, is.indirect, 1.0);
    }
    EXPECT_NEAR(report.transfer_error, std::sqrt(error / size), 1e-6);
    EXPECT_GT(report.transfer_error, 1e-4);
    EXPECT_LT(report.transfer_error, 0.08);
    EXPECT_LE(report.light_error, report.worst_light_error);
    EXPECT_LT(report.bytes, report.bytes_before / 3);
    const CompressedTransfer &a = *small.meshes[0].transfer->compressed,
                             &b = *small.meshes[1].transfer->compressed;
    EXPECT_EQ(report.bytes, a.bytes(half_float) + b.bytes(half_float) + a.of->bytes(half_float));
  }
}

TEST(CompressTransfer, WithoutBouncesToo) {
  CompressReport report;
  const Scene small = compressTransfer(baked(0), {.clusters = 8, .vectors = 16}, {}, &report);
  EXPECT_LT(report.transfer_error, 1e-5) << "as many vectors as numbers";
  EXPECT_TRUE(small.meshes[0].transfer->indirect.empty());
}

TEST(CompressTransfer, RefusesWhatItCannotDo) {
  const auto refused = [](const Scene& scene, const CompressOptions& options, const char* part) {
    try {
      compressTransfer(scene, options);
      ADD_FAILURE() << part;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused(boxScene(), {}, "no mesh");
  refused(baked(0), {.clusters = 0}, "clusters: 0 is not from 1");
  refused(baked(0), {.vectors = 145}, "vectors: 145");
  Progress stopping;
  stopping.should_stop = [] { return true; };
  EXPECT_THROW(compressTransfer(baked(0), {}, stopping), Interrupted);
}

}  // namespace
}  // namespace gloam::prt
