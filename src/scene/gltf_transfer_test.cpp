// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/gltf_transfer.h"

#include <gloam/compress.h>
#include <gloam/sh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>

#include "scene/builtin_scenes.h"
#include "scene/glb_test_file.h"
#include "scene/half_float.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Scene bakedScene(int bounces) {
  Scene scene = makeBuiltinScene("bowl?detail=0.25");
  auto transfer = std::make_shared<Transfer>();
  transfer->order = 3;
  transfer->bounces = bounces;
  transfer->directions = 1024;
  const std::size_t count = scene.meshes[0].vertexCount() * 9;
  for (std::size_t i = 0; i < count; ++i) transfer->direct.push_back(std::sin(float(i)));
  if (bounces > 0) {
    for (std::size_t i = 0; i < 3 * count; ++i) transfer->indirect.push_back(0.3f * std::cos(float(i)));
  }
  scene.meshes[0].transfer = transfer;
  return scene;
}

/// With glossy transfer from two bands to three.
Scene glossyScene(int bounces) {
  Scene scene = bakedScene(bounces);
  auto transfer = std::make_shared<Transfer>(*scene.meshes[0].transfer);
  GlossyTransfer& glossy = transfer->glossy;
  glossy.light_order = 2;
  glossy.field_order = 3;
  const std::size_t vertices = scene.meshes[0].vertexCount();
  for (std::size_t i = 0; i < vertices * 16; ++i) glossy.visibility.push_back(std::sin(0.7f * float(i)));
  for (std::size_t i = 0; i < vertices * 36 * 3 && bounces > 0; ++i)
    glossy.indirect.push_back(std::cos(0.3f * float(i)));
  scene.meshes[0].transfer = transfer;
  return scene;
}

/// Compressed, in three clusters of two vectors.
Scene compressedScene(int bounces) {
  Scene scene = bakedScene(bounces);
  auto transfer = std::make_shared<Transfer>(*scene.meshes[0].transfer);
  TransferClusters of{.clusters = 3, .vectors = 2};
  CompressedTransfer pca;
  const std::size_t width = bounces > 0 ? 36 : 9, vertices = scene.meshes[0].vertexCount();
  for (std::size_t i = 0; i < 3 * width; ++i) of.means.push_back(std::sin(0.7f * float(i)));
  for (std::size_t i = 0; i < 6 * width; ++i) of.basis.push_back(std::cos(0.3f * float(i)));
  for (std::size_t i = 0; i < 2 * vertices; ++i) pca.weights.push_back(0.2f * std::sin(float(i)));
  for (std::size_t v = 0; v < vertices; ++v) pca.cluster.push_back(std::uint16_t(v * v % 3));
  pca.of = std::make_shared<const TransferClusters>(std::move(of));
  expandTransfer(pca, *transfer);
  transfer->compressed = std::make_shared<const CompressedTransfer>(std::move(pca));
  scene.meshes[0].transfer = transfer;
  return scene;
}

fs::path temporary() {
  return fs::temp_directory_path() / "gloam_transfer_test.glb";
}

using Glb = test::GlbChunks;

Json& extensionOf(Glb& glb) {
  return glb.json["meshes"][0]["primitives"][0]["extensions"][kTransferExtension];
}

/// Writes a baked scene, breaks it, and gives what the reader says.
std::string messageAfter(const std::function<void(Glb&)>& breakIt, const Scene& scene = bakedScene(2)) {
  gloam::writeGlb(scene, temporary());
  Glb glb = test::readGlbChunks(temporary());
  breakIt(glb);
  test::writeGlbChunks(glb, temporary());
  std::string message = "no error";
  try {
    loadScene(temporary().string());
  } catch (const Error& error) {
    message = error.what();
  }
  fs::remove(temporary());
  return message;
}

TEST(HalfFloat, EveryHalfComesBackAndRoundingIsToTheNearest) {
  for (std::uint32_t h = 0; h < 0x10000u; ++h) {
    const float value = floatFromHalf(std::uint16_t(h));
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(halfFromFloat(value), h);
    if ((h & 0x7FFFu) == 0x7BFFu) continue;
    const float next = floatFromHalf(std::uint16_t(h + 1)), middle = 0.5f * (value + next);
    ASSERT_EQ(halfFromFloat(middle), h & 1u ? h + 1 : h) << value;  // ties to even
    ASSERT_EQ(halfFromFloat(std::nextafter(middle, value)), h);
    ASSERT_EQ(halfFromFloat(std::nextafter(middle, next)), h + 1);
  }
  EXPECT_EQ(halfFromFloat(1e9f), 0x7BFFu);
  EXPECT_EQ(halfFromFloat(-INFINITY), 0xFBFFu);
  EXPECT_TRUE(std::isnan(floatFromHalf(halfFromFloat(NAN))));
}

TEST(Transfer, ComesBackExactlyAsFloatsAndRoundedAsHalves) {
  for (const int bounces : {0, 2}) {
    for (const bool half_float : {false, true}) {
      const Scene scene = bakedScene(bounces);
      gloam::writeGlb(scene, temporary(), {half_float});
      const Scene again = loadScene(temporary().string());
      fs::remove(temporary());
      const Transfer& a = *scene.meshes[0].transfer;
      ASSERT_TRUE(again.meshes[0].transfer);
      const Transfer& b = *again.meshes[0].transfer;
      EXPECT_EQ(b.order, 3);
      EXPECT_EQ(b.bounces, bounces);
      EXPECT_EQ(b.directions, 1024);
      ASSERT_EQ(a.direct.size(), b.direct.size());
      ASSERT_EQ(a.indirect.size(), b.indirect.size());
      for (std::size_t i = 0; i < a.direct.size(); ++i) {
        EXPECT_EQ(b.direct[i], half_float ? floatFromHalf(halfFromFloat(a.direct[i])) : a.direct[i]);
      }
    }
  }
}

TEST(Transfer, FollowsVerticesThatTheReaderDrops) {
  Scene scene = bakedScene(0);
  Mesh& mesh = scene.meshes[0];
  // Without its first triangle the first vertex is used by no other.
  const std::size_t before = mesh.vertexCount();
  std::vector<std::uint32_t> kept;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    if (mesh.indices[t] == 0 || mesh.indices[t + 1] == 0 || mesh.indices[t + 2] == 0) continue;
    kept.insert(kept.end(), mesh.indices.begin() + std::ptrdiff_t(t),
                mesh.indices.begin() + std::ptrdiff_t(t + 3));
  }
  mesh.indices = kept;
  gloam::writeGlb(scene, temporary());
  const Scene again = loadScene(temporary().string());
  fs::remove(temporary());
  ASSERT_LT(again.meshes[0].vertexCount(), before);
  for (std::size_t v = 0; v < again.meshes[0].vertexCount(); ++v) {
    for (std::size_t old = 0; old < before; ++old) {
      if (mesh.positions[old] != again.meshes[0].positions[v] ||
          mesh.uv_sets[0][old] != again.meshes[0].uv_sets[0][v]) {
        continue;
      }
      EXPECT_EQ(again.meshes[0].transfer->direct[9 * v + 4], mesh.transfer->direct[9 * old + 4]);
    }
  }
}

/// Transfer of a lightmap of 5 x 3 texels.
Scene texelScene() {
  Scene scene = bakedScene(0);
  Mesh& mesh = scene.meshes[0];
  mesh.uv_sets.resize(2);
  for (const glm::vec3& p : mesh.positions)
    mesh.uv_sets[1].emplace_back(0.5f + 0.1f * p.x, 0.5f + 0.1f * p.z);
  auto transfer = std::make_shared<Transfer>(*mesh.transfer);
  transfer->texel_width = 5;
  transfer->texel_height = 3;
  transfer->uv_set = 1;
  transfer->bounces = 1;
  transfer->direct.clear();
  for (int i = 0; i < 15 * 9; ++i) transfer->direct.push_back(std::sin(float(i)));
  for (int i = 0; i < 15 * 27; ++i) transfer->indirect.push_back(std::cos(float(i)));
  mesh.transfer = transfer;
  return scene;
}

TEST(Transfer, TexelsComeBack) {
  for (const bool half_float : {false, true}) {
    const Scene scene = texelScene();
    gloam::writeGlb(scene, temporary(), {half_float});
    Glb glb = test::readGlbChunks(temporary());
    EXPECT_EQ(extensionOf(glb)["version"], 2) << "older readers know no texels";
    const Scene again = loadScene(temporary().string());
    fs::remove(temporary());
    const Transfer &a = *scene.meshes[0].transfer, &b = *again.meshes[0].transfer;
    EXPECT_EQ(b.texel_width, 5);
    EXPECT_EQ(b.texel_height, 3);
    EXPECT_EQ(b.uv_set, 1);
    ASSERT_EQ(b.direct.size(), a.direct.size());
    ASSERT_EQ(b.indirect.size(), a.indirect.size());
    for (std::size_t i = 0; i < a.direct.size(); ++i)
      EXPECT_EQ(b.direct[i], half_float ? floatFromHalf(halfFromFloat(a.direct[i])) : a.direct[i]);
    if (!half_float) {
      EXPECT_EQ(b.indirect, a.indirect);
    }
  }
  Scene vertices = bakedScene(0);
  gloam::writeGlb(vertices, temporary());
  Glb glb = test::readGlbChunks(temporary());
  EXPECT_EQ(extensionOf(glb)["version"], 1);
  fs::remove(temporary());
}

// Vertices that no triangle uses are dropped; the lightmap is not of vertices.
TEST(Transfer, TexelsStayWhenVerticesAreDropped) {
  Scene scene = texelScene();
  Mesh& mesh = scene.meshes[0];
  mesh.indices.resize(mesh.indices.size() / 2 / 3 * 3);
  gloam::writeGlb(scene, temporary());
  const Scene again = loadScene(temporary().string());
  fs::remove(temporary());
  ASSERT_LT(again.meshes[0].vertexCount(), mesh.vertexCount());
  EXPECT_EQ(again.meshes[0].transfer->direct, mesh.transfer->direct);
  EXPECT_EQ(again.meshes[0].transfer->indirect, mesh.transfer->indirect);
}

TEST(Transfer, ErrorsOfTexelsNameTheField) {
  const auto says = [](const char* part, const std::function<void(Json&)>& change) {
    const std::string message = messageAfter([&](Glb& glb) { change(extensionOf(glb)); }, texelScene());
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  says("no error", [](Json&) {});
  says(".texels.width: missing", [](Json& j) { j["texels"].erase("width"); });
  says(".texels.height: 0 is not", [](Json& j) { j["texels"]["height"] = 0; });
  says(".texels.width: 100000000 is not", [](Json& j) { j["texels"]["width"] = 100000000; });
  says(".direct: accessors[", [](Json& j) { j["texels"]["height"] = 4; });
  says(".direct: accessors[", [](Json& j) { j["texels"]["width"] = 65536, j["texels"]["height"] = 65536; });
  says(".texels.texCoord: the primitive has no TEXCOORD_3", [](Json& j) { j["texels"]["texCoord"] = 3; });
  says("belongs to other texture coordinates", [](Json& j) { j["texels"]["texCoord"] = 0; });
  says("belongs to other texture coordinates", [](Json& j) { j["texels"]["uvs"] = "00000000"; });
  says(".texels: an object was expected", [](Json& j) { j["texels"] = 5; });
  says(".direct: accessors[", [](Json& j) { j["version"] = 1; });
}

TEST(Transfer, ChecksumIsThatOfZlib) {
  // crc32(b"") = 0; crc32 of the bytes of the floats 1, 2, 3 and the indices 0, 1, 2 (zlib.crc32 in Python).
  EXPECT_EQ(geometryChecksum({}, {}), "00000000");
  const glm::vec3 p(1, 2, 3);
  const std::uint32_t triangle[3] = {0, 1, 2};
  EXPECT_EQ(geometryChecksum({&p, 1}, triangle), "bbc4f84e");
}

TEST(Transfer, TheExampleInTheDocumentIsRight) {
  // docs/formats/GLOAM_precomputed_transfer.md, "An example in numbers".
  const glm::vec3 positions[3] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  const std::uint32_t indices[3] = {0, 1, 2};
  EXPECT_EQ(geometryChecksum(positions, indices), "13584cff");
  const sh::Sh y = sh::evaluate(3, {0, 1, 0});
  const float direct[9] = {0.886227f, 1.023327f, 0, 0, 0, 0, -0.247708f, 0, -0.429043f};
  const std::uint16_t halves[9] = {0x3B17, 0x3C18, 0, 0, 0, 0, 0xB3ED, 0, 0xB6DD};
  float irradiance = 0.0f;
  for (int i = 0; i < 9; ++i) {
    const int band = i == 0 ? 0 : i < 4 ? 1 : 2;
    EXPECT_NEAR(sh::clampedCosineFactor(band) * y[i], direct[i], 1e-6f);
    EXPECT_EQ(halfFromFloat(direct[i]) & 0x7FFF, halves[i] & 0x7FFF);
    irradiance += direct[i] * y[i];
  }
  EXPECT_NEAR(irradiance, 1.0625f, 1e-5f);
}

TEST(Transfer, CompressedComesBackExpanded) {
  for (const int bounces : {0, 2}) {
    const Scene scene = compressedScene(bounces);
    const Transfer& a = *scene.meshes[0].transfer;
    const std::size_t width = bounces > 0 ? 36 : 9, v = 5, k = a.compressed->cluster[v];
    // One number by hand: coefficient 4 of vertex 5, then its green bounce.
    const auto number = [&](std::size_t d) {
      const CompressedTransfer& pca = *a.compressed;
      return pca.of->means[k * width + d] + pca.weights[2 * v] * pca.of->basis[2 * k * width + d] +
             pca.weights[2 * v + 1] * pca.of->basis[(2 * k + 1) * width + d];
    };
    EXPECT_NEAR(a.direct[9 * v + 4], number(4), 1e-6f);
    if (bounces > 0) {
      EXPECT_NEAR(a.indirect[3 * (9 * v + 4) + 1], number(9 + 3 * 4 + 1), 1e-6f);
    }
    gloam::writeGlb(scene, temporary());
    const Scene again = loadScene(temporary().string());
    fs::remove(temporary());
    const Transfer& b = *again.meshes[0].transfer;
    EXPECT_EQ(a.direct, b.direct);
    EXPECT_EQ(a.indirect, b.indirect);
    ASSERT_TRUE(b.compressed);
    EXPECT_EQ(a.compressed->cluster, b.compressed->cluster);
  }
}

TEST(Transfer, CompressedErrorsNameTheField) {
  const auto expect = [](const std::function<void(Glb&, Json&)>& breakIt, const char* part) {
    const std::string message =
        messageAfter([&](Glb& glb) { breakIt(glb, extensionOf(glb)["pca"]); }, compressedScene(2));
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  const auto bytesOf = [](Glb& glb, const Json& accessor) -> char* {
    const Json& view =
        glb.json["bufferViews"]
                [glb.json["accessors"][accessor.get<std::size_t>()]["bufferView"].get<std::size_t>()];
    return &glb.binary[view.value("byteOffset", std::size_t(0))];
  };
  expect([](Glb&, Json& g) { g = 5; }, ".pca: an object was expected");
  for (const char* name : {"clusters", "vectors", "means", "basis", "weights", "cluster"})
    expect([name](Glb&, Json& g) { g.erase(name); }, (std::string(".pca.") + name + ": missing").c_str());
  expect([](Glb&, Json& g) { g["clusters"] = 0; }, ".pca.clusters: 0 is not a whole number from 1");
  expect([](Glb&, Json& g) { g["vectors"] = 37; }, ".pca.vectors: 37");
  expect([](Glb&, Json& g) { g["clusters"] = 4; }, ".pca.means: accessors[");
  expect([](Glb&, Json& g) { g["vectors"] = 3; }, ".pca.basis: accessors[");
  expect([](Glb&, Json& g) { g["cluster"] = g["means"]; }, ".pca.cluster: accessors[");
  expect([](Glb&, Json& g) { g["weights"] = 999; }, ".pca.weights: 999");
  expect([&](Glb& glb, Json& g) { bytesOf(glb, g["cluster"])[7] = 3; }, "is 3; there are 3");
  expect([&](Glb& glb, Json& g) { std::memset(bytesOf(glb, g["weights"]), 0xff, 4); },
         ".pca.weights: element 0");
  expect([](Glb& glb, Json&) { extensionOf(glb)["version"] = 4; }, ".version: 4 is not known");
  expect([](Glb& glb, Json&) { extensionOf(glb)["version"] = 1; }, ".direct: missing");
}

TEST(Transfer, ErrorsNameTheField) {
  const auto contains = [](const std::string& message, const char* part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find(kTransferExtension), std::string::npos) << message;
  };
  contains(messageAfter([](Glb& g) { extensionOf(g)["version"] = 9; }), ".version: 9 is not known");
  contains(messageAfter([](Glb& g) { extensionOf(g).erase("version"); }), ".version: missing");
  contains(messageAfter([](Glb& g) { extensionOf(g)["order"] = 7; }), ".order: 7");
  contains(messageAfter([](Glb& g) { extensionOf(g)["order"] = 4; }), ".direct: accessors[");
  contains(messageAfter([](Glb& g) { extensionOf(g)["order"] = "5"; }), ".order: \"5\"");
  contains(messageAfter([](Glb& g) { extensionOf(g).erase("direct"); }), ".direct: missing");
  contains(messageAfter([](Glb& g) { extensionOf(g).erase("indirect"); }), ".indirect: missing");
  contains(messageAfter([](Glb& g) { extensionOf(g)["direct"] = 999; }), ".direct: 999");
  contains(messageAfter([](Glb& g) { extensionOf(g)["direct"] = 0; }),
           ".direct: accessors[0] must be SCALAR");
  contains(messageAfter([](Glb& g) { extensionOf(g)["bounces"] = 0; }), ".indirect: there are no bounces");
  contains(messageAfter([](Glb& g) { extensionOf(g)["format"] = "double"; }), ".format");
  contains(messageAfter([](Glb& g) { extensionOf(g)["format"] = "half"; }), ".direct: accessors[");
  contains(messageAfter([](Glb& g) { extensionOf(g)["geometry"] = "12345678"; }), "belongs to another mesh");
  contains(messageAfter([](Glb& g) { extensionOf(g) = 3; }), "an object was expected");
}

TEST(Transfer, GlossyPartComesBack) {
  for (const int bounces : {0, 2}) {
    for (const bool half_float : {false, true}) {
      Scene scene = glossyScene(bounces);
      gloam::writeGlb(scene, temporary(), {half_float});
      const Scene again = loadScene(temporary().string());
      fs::remove(temporary());
      const GlossyTransfer &a = scene.meshes[0].transfer->glossy, &b = again.meshes[0].transfer->glossy;
      EXPECT_EQ(b.light_order, 2);
      EXPECT_EQ(b.field_order, 3);
      EXPECT_EQ(b.exponent, 0.0f);
      ASSERT_EQ(a.visibility.size(), b.visibility.size());
      ASSERT_EQ(a.indirect.size(), b.indirect.size());
      for (std::size_t i = 0; i < a.indirect.size(); ++i)
        ASSERT_EQ(b.indirect[i], half_float ? floatFromHalf(halfFromFloat(a.indirect[i])) : a.indirect[i]);
      for (std::size_t i = 0; i < a.visibility.size(); ++i)
        ASSERT_EQ(b.visibility[i],
                  half_float ? floatFromHalf(halfFromFloat(a.visibility[i])) : a.visibility[i]);
    }
  }
  Scene fixed = glossyScene(1);
  auto transfer = std::make_shared<Transfer>(*fixed.meshes[0].transfer);
  transfer->glossy.exponent = 7.5f;
  fixed.meshes[0].transfer = transfer;
  gloam::writeGlb(fixed, temporary());
  EXPECT_EQ(loadScene(temporary().string()).meshes[0].transfer->glossy.exponent, 7.5f);
  fs::remove(temporary());
}

TEST(Transfer, GlossyErrorsNameTheField) {
  const auto expect = [](const std::function<void(Json&)>& breakIt, const char* part) {
    const std::string message =
        messageAfter([&](Glb& glb) { breakIt(extensionOf(glb)["glossy"]); }, glossyScene(2));
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect([](Json& g) { g = 5; }, ".glossy: an object was expected");
  expect([](Json& g) { g.erase("lightOrder"); }, ".glossy.lightOrder: missing");
  expect([](Json& g) { g["lightOrder"] = 4; }, ".glossy.lightOrder: 4 is not a whole number from 1 to 3");
  expect([](Json& g) { g["fieldOrder"] = 7; }, ".glossy.fieldOrder: 7");
  expect([](Json& g) { g["fieldOrder"] = 4; }, ".glossy.visibility: accessors[");
  expect([](Json& g) { g.erase("visibility"); }, ".glossy.visibility: missing");
  expect([](Json& g) { g.erase("indirect"); }, ".glossy.indirect: missing");
  expect([](Json& g) { g["indirect"] = g["visibility"]; }, ".glossy.indirect: accessors[");
  expect([](Json& g) { g["exponent"] = 0; }, ".glossy.exponent: 0 is not a number from 1");
  expect([](Json& g) { g["exponent"] = "sharp"; }, ".glossy.exponent: \"sharp\"");
}

TEST(Transfer, ValuesThatAreNotNumbersAreRefused) {
  const std::string message = messageAfter([](Glb& glb) {
    const Json& accessor = glb.json["accessors"][extensionOf(glb)["indirect"].get<std::size_t>()];
    const std::size_t offset =
        glb.json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"];
    const float nan = NAN;
    std::memcpy(&glb.binary[offset + 40], &nan, 4);
  });
  EXPECT_NE(message.find(".indirect: element 10 of accessors["), std::string::npos) << message;
}

TEST(Transfer, NumbersBeyondTheLargestHalfAreRefused) {
  const std::string message = messageAfter([](Glb& glb) {
    const Json& accessor = glb.json["accessors"][extensionOf(glb)["direct"].get<std::size_t>()];
    const std::size_t offset =
        glb.json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"];
    const float large = 65536.0f;
    std::memcpy(&glb.binary[offset + 8], &large, 4);
  });
  EXPECT_NE(message.find(".direct: element 2 of accessors["), std::string::npos) << message;
  EXPECT_NE(message.find("is 65536; 65504 is the most"), std::string::npos) << message;
}

TEST(Transfer, GeometryThatChangedIsRefused) {
  const std::string message = messageAfter([](Glb& glb) {
    const Json& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
    Json& accessor = glb.json["accessors"][attributes["POSITION"].get<std::size_t>()];
    const std::size_t offset =
        glb.json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"];
    glb.binary[offset + 13] = char(glb.binary[offset + 13] ^ 1);
  });
  EXPECT_NE(message.find("belongs to another mesh"), std::string::npos) << message;
}

}  // namespace
}  // namespace gloam
