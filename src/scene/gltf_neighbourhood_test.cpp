// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/gltf_neighbourhood.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>

#include "scene/builtin_scenes.h"
#include "scene/glb_test_file.h"
#include "scene/half_float.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

NeighbourhoodTransfer someGrid(int bounces) {
  NeighbourhoodTransfer grid;
  grid.centre = {-1.5f, 0.25f, -2.0f};
  grid.spacing = {0.5f, 0.25f, 1.0f};
  grid.core = {0.25f, 0.0f, 0.4f};
  grid.growth = {0.5f, 0.125f, 0.1f};
  grid.size = {3, 4, 2};
  grid.light_order = 2;
  grid.field_order = 3;
  grid.bounces = bounces;
  for (std::size_t i = 0; i < 24 * 16; ++i) grid.visibility.push_back(std::sin(float(i)));
  for (std::size_t i = 0; i < 24 * 36 * 3 && bounces > 0; ++i)
    grid.indirect.push_back(0.1f * std::cos(float(i)));
  return grid;
}

Scene carryingScene(int bounces) {
  Scene scene = makeBuiltinScene("furnace?detail=0.25");
  scene.nodes[0].neighbourhood = std::make_shared<NeighbourhoodTransfer>(someGrid(bounces));
  return scene;
}

fs::path temporary() {
  return fs::temp_directory_path() / "gloam_neighbourhood_test.glb";
}

struct Glb : test::GlbChunks {
  Json& extension() { return json["nodes"][0]["extensions"][kNeighbourhoodExtension]; }
  auto* visibilityBytes() {
    const Json& accessor = json["accessors"][extension()["visibility"].get<std::size_t>()];
    const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    return &binary[view.value("byteOffset", std::size_t(0))];
  }
};

/// Writes a grid, breaks it, and gives what the reader says.
std::string messageAfter(const std::function<void(Glb&)>& breakIt, int bounces = 1, bool half_float = false) {
  writeGlb(carryingScene(bounces), temporary(), {half_float});
  Glb glb{test::readGlbChunks(temporary())};
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

TEST(Neighbourhood, ComesBackExactlyAsFloatsAndRoundedAsHalves) {
  for (const int bounces : {0, 2}) {
    for (const bool half_float : {false, true}) {
      const Scene scene = carryingScene(bounces);
      writeGlb(scene, temporary(), {half_float});
      const Scene again = loadScene(temporary().string());
      fs::remove(temporary());
      ASSERT_TRUE(again.nodes[0].neighbourhood);
      const NeighbourhoodTransfer &a = *scene.nodes[0].neighbourhood, &b = *again.nodes[0].neighbourhood;
      EXPECT_EQ(a.size, b.size);
      EXPECT_EQ(a.centre, b.centre);
      EXPECT_EQ(a.spacing, b.spacing);
      EXPECT_EQ(a.core, b.core);
      EXPECT_EQ(a.growth, b.growth);
      EXPECT_EQ(a.light_order, b.light_order);
      EXPECT_EQ(a.field_order, b.field_order);
      EXPECT_EQ(b.bounces, bounces);
      ASSERT_EQ(a.visibility.size(), b.visibility.size());
      ASSERT_EQ(a.indirect.size(), b.indirect.size());
      for (std::size_t i = 0; i < a.visibility.size(); ++i)
        EXPECT_EQ(b.visibility[i],
                  half_float ? floatFromHalf(halfFromFloat(a.visibility[i])) : a.visibility[i]);
    }
  }
}

TEST(Neighbourhood, TheFirstVersionIsReadAsAnEvenGrid) {
  writeGlb(carryingScene(0), temporary());
  Glb glb{test::readGlbChunks(temporary())};
  Json& extension = glb.extension();
  for (const char* name : {"centre", "core", "growth"}) extension.erase(name);
  extension["version"] = 1;
  extension["firstPoint"] = {-1.5, 0.25, -2.0};
  test::writeGlbChunks(glb, temporary());
  const Scene scene = loadScene(temporary().string());
  fs::remove(temporary());
  ASSERT_TRUE(scene.nodes[0].neighbourhood);
  const NeighbourhoodTransfer& grid = *scene.nodes[0].neighbourhood;
  for (std::size_t p = 0; p < grid.points(); ++p) {
    const glm::vec3 number(grid.pointAt(p));
    const glm::vec3 at = glm::vec3(-1.5f, 0.25f, -2.0f) + number * glm::vec3(0.5f, 0.25f, 1.0f);
    EXPECT_LT(glm::length(grid.position(p) - at), 1e-6f) << p;
    EXPECT_LT(glm::length(grid.placeOf(at) - number), 1e-5f) << p;
  }
}

// Three points a side of spacing 1, even to 0.5, growth 2: the last stands at 0.5 + 2 (e^(0.5 / 2) - 1) = 1.068051.
TEST(Neighbourhood, PointsGrowApartBeyondTheCore) {
  NeighbourhoodTransfer grid;
  grid.size = {3, 4, 2};
  grid.centre = {10.0f, 0.0f, -3.0f};
  grid.core = {0.5f, 100.0f, 0.0f};
  grid.growth = {2.0f, 1.0f, 0.5f};
  EXPECT_NEAR(grid.position(glm::vec3(2, 0, 0)).x, 11.068051f, 1e-5f);
  EXPECT_NEAR(grid.position(glm::vec3(0, 0, 0)).x, 8.931949f, 1e-5f);
  EXPECT_NEAR(grid.position(glm::vec3(1, 0, 0)).x, 10.0f, 1e-6f);
  EXPECT_NEAR(grid.position(glm::vec3(1, 3, 0)).y, 1.5f, 1e-6f);
  EXPECT_NEAR(grid.half().z, 0.5f * (std::exp(1.0f) - 1.0f), 1e-5f);
  for (std::size_t p = 0; p < grid.points(); ++p)
    EXPECT_LT(glm::length(grid.placeOf(grid.position(p)) - glm::vec3(grid.pointAt(p))), 1e-4f) << p;
}

TEST(Neighbourhood, BadFilesAreAnswered) {
  const auto expectSays = [](const std::string& message, const char* what) {
    EXPECT_NE(message.find(what), std::string::npos) << message;
    EXPECT_NE(message.find("nodes[0].extensions.GLOAM_neighbourhood_transfer"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  };
  expectSays(messageAfter([](Glb& glb) { glb.extension()["version"] = 3; }), "3 is not known");
  expectSays(messageAfter([](Glb& glb) { glb.extension() = 7; }), "object");
  expectSays(messageAfter([](Glb& glb) { glb.extension().erase("visibility"); }), "visibility: missing");
  expectSays(messageAfter([](Glb& glb) { glb.extension().erase("indirect"); }), "indirect: missing");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["visibility"] = 99; }), "99");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["size"] = {3, 4, 3}; }), "were expected");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["size"] = {4096, 4096, 4096}; }), "were expected");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["size"] = {3, 4}; }), "three numbers");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["size"] = {3, 4, 1}; }), "1 is not a whole number");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["spacing"] = {1, 0, 1}; }), "spacing");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["core"] = {1, -1, 1}; }), "core");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["growth"] = {1, 1, 0}; }), "growth");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["growth"] = {1, 1e-6, 1}; }), "beyond 1e18");
  expectSays(messageAfter([](Glb& glb) { glb.extension().erase("centre"); }), "centre: missing");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["lightOrder"] = 4; }), "lightOrder");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["format"] = "double"; }), "format");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["format"] = "half"; }), "component type 5123");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["bounces"] = 0; }), "there are no bounces");
  expectSays(messageAfter([](Glb& glb) {
               const float bad = NAN;
               std::memcpy(glb.visibilityBytes() + 20, &bad, 4);
             }),
             "element 5 of accessors");
  expectSays(messageAfter([](Glb& glb) {
               const float large = -65600.0f;
               std::memcpy(glb.visibilityBytes() + 12, &large, 4);
             }),
             "is -65600; 65504 is the most");
  expectSays(messageAfter(
                 [](Glb& glb) {
                   const std::uint16_t infinity = 0x7C00;
                   std::memcpy(glb.visibilityBytes() + 6, &infinity, 2);
                 },
                 1, true),
             "element 3 of accessors");
}

TEST(Neighbourhood, NumbersThatHalvesCannotHoldAreHeldToTheLargest) {
  Scene scene = carryingScene(0);
  auto grid = std::make_shared<NeighbourhoodTransfer>(someGrid(0));
  grid->visibility[1] = 65504.0f;
  grid->visibility[2] = -1e6f;
  scene.nodes[0].neighbourhood = grid;
  writeGlb(scene, temporary(), {.half_float = true});
  const Scene again = loadScene(temporary().string());
  fs::remove(temporary());
  EXPECT_EQ(again.nodes[0].neighbourhood->visibility[1], 65504.0f);
  EXPECT_EQ(again.nodes[0].neighbourhood->visibility[2], -65504.0f);
}

// A node below one that carries a grid has none: which of them its meshes throw by would be undefined.
TEST(Neighbourhood, GridsBelowGridsAreRefused) {
  for (const bool grandchild : {false, true}) {
    const std::string message = messageAfter([grandchild](Glb& glb) {
      Json& nodes = glb.json["nodes"];
      const std::size_t added = nodes.size();
      nodes.push_back({{"extensions", {{kNeighbourhoodExtension, glb.extension()}}}});
      if (grandchild) nodes.push_back({{"children", {added}}});
      nodes[0]["children"].push_back(nodes.size() - 1);
    });
    EXPECT_NE(message.find("extensions.GLOAM_neighbourhood_transfer: node 0 above it has one already"),
              std::string::npos)
        << message;
  }
  // Beside each other they may stand.
  EXPECT_EQ(messageAfter([](Glb& glb) {
              Json& nodes = glb.json["nodes"];
              glb.json["scenes"][0]["nodes"].push_back(nodes.size());
              nodes.push_back({{"extensions", {{kNeighbourhoodExtension, glb.extension()}}}});
            }),
            "no error");
}

}  // namespace
}  // namespace gloam
