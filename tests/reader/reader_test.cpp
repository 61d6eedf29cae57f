// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// examples/relight.cpp, which was written from docs/formats/ and shares no line with gloam, gives the irradiance that gloam
// computes from the same file: floats, halves, compressed and not, with and without bounces.
#include <gloam/bake.h>
#include <gloam/compress.h>
#include <gloam/sh.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "techniques/prt/prt_bake_test_scenes.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;

class Reader : public testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / "gloam_reader_test";
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }

  int run(const std::string& file, const std::string& direction, std::string* error = nullptr) const {
    const char* reader = std::getenv("READER");
    EXPECT_NE(reader, nullptr);
    const fs::path errors = folder / "errors";
    const std::string command = std::string(reader ? reader : "false") + " " + (folder / file).string() +
                                " " + direction + " " + (folder / "out.ply").string() + " 2> " +
                                errors.string();
    const int status = std::system(command.c_str());
    std::ifstream stream(errors);
    if (error != nullptr) std::getline(stream, *error);
    return WEXITSTATUS(status);
  }

  std::vector<glm::vec3> irradianceOfPly() const {
    std::ifstream stream(folder / "out.ply");
    std::string line;
    while (std::getline(stream, line) && line != "end_header") {
    }
    std::vector<glm::vec3> values;
    glm::vec3 p, e;
    while (stream >> p.x >> p.y >> p.z >> e.x >> e.y >> e.z) values.push_back(e);
    return values;
  }
};

/// A box over a floor; every vertex is a triangle's, so that gloam drops none.
Scene boxScene() {
  Scene scene = prt::sceneOf(prt::gridMesh(1.0f, 16));
  Mesh box = prt::boxMesh(glm::vec3(0.3f), false);
  for (glm::vec3& p : box.positions) p.y += 0.4f;
  prt::addMesh(scene, box);
  return scene;
}

Scene baked(bool bounces) {
  return bakeTransfer(boxScene(), {.kind = bounces ? TransferKind::kInterreflected : TransferKind::kShadowed,
                                   .order = bounces ? 5 : 6,
                                   .bounces = 1,
                                   .directions = 256,
                                   .bounce_directions = 256});
}

// E = sum of (direct + indirect) L, L by gloam's own basis.
std::vector<glm::vec3> irradianceByGloam(const Scene& scene, const glm::vec3& lamp) {
  std::vector<glm::vec3> all;
  for (const Mesh& mesh : scene.meshes) {
    if (!mesh.transfer) continue;
    const Transfer& transfer = *mesh.transfer;
    sh::Sh light = sh::directionalLight(transfer.order, glm::normalize(lamp));
    light[0] += 0.3f * std::sqrt(4.0f * 3.14159265f);
    const auto n = std::size_t(light.size());
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      glm::dvec3 sum(0.0);
      for (std::size_t i = 0; i < n; ++i) {
        for (int c = 0; c < 3; ++c) {
          double m = double(transfer.direct[v * n + i]);
          if (!transfer.indirect.empty()) m += double(transfer.indirect[3 * (v * n + i) + std::size_t(c)]);
          sum[c] += m * double(light[int(i)]);
        }
      }
      all.emplace_back(sum);
    }
  }
  return all;
}

TEST_F(Reader, GivesWhatGloamGives) {
  for (const bool bounces : {false, true}) {
    for (const bool half_float : {false, true}) {
      for (const bool compressed : {false, true}) {
        Scene scene = baked(bounces);
        if (compressed)
          scene = compressTransfer(scene, {.clusters = 3, .vectors = 6, .half_float = half_float});
        writeGlb(scene, folder / "a.glb", {.half_float = half_float});
        const std::vector<glm::vec3> want =
            irradianceByGloam(loadScene((folder / "a.glb").string()), {0.3f, 0.8f, -0.5f});
        ASSERT_EQ(run("a.glb", "0.3 0.8 -0.5"), 0);
        const std::vector<glm::vec3> got = irradianceOfPly();
        ASSERT_EQ(got.size(), want.size());
        for (std::size_t i = 0; i < got.size(); ++i)
          ASSERT_LT(glm::length(got[i] - want[i]), 2e-5f) << i << " " << bounces << half_float << compressed;
      }
    }
  }
}

TEST_F(Reader, RefusesWhatItDoesNotKnow) {
  std::string error;
  EXPECT_EQ(run("missing.glb", "0 1 0", &error), 2);
  EXPECT_NE(error.find("not a .glb"), std::string::npos) << error;
  writeGlb(boxScene(), folder / "bare.glb");
  EXPECT_EQ(run("bare.glb", "0 1 0", &error), 2);
  EXPECT_NE(error.find("holds no transfer"), std::string::npos) << error;
}

TEST_F(Reader, IsShort) {
  std::ifstream stream(fs::path(__FILE__).parent_path() / "../../examples/relight.cpp");
  int lines = 0;
  for (std::string line; std::getline(stream, line);) ++lines;
  EXPECT_GT(lines, 50);
  EXPECT_LT(lines, 150);
}

}  // namespace
}  // namespace gloam
