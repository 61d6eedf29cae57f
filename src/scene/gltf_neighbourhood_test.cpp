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
  grid.first_point = {-1.5f, 0.25f, -2.0f};
  grid.spacing = {0.5f, 0.25f, 1.0f};
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
};

/// Writes a grid, breaks it, and gives what the reader says.
std::string messageAfter(const std::function<void(Glb&)>& breakIt, int bounces = 1) {
  writeGlb(carryingScene(bounces), temporary());
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
      EXPECT_EQ(a.first_point, b.first_point);
      EXPECT_EQ(a.spacing, b.spacing);
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

TEST(Neighbourhood, BadFilesAreAnswered) {
  const auto expectSays = [](const std::string& message, const char* what) {
    EXPECT_NE(message.find(what), std::string::npos) << message;
    EXPECT_NE(message.find("nodes[0].extensions.GLOAM_neighbourhood_transfer"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  };
  expectSays(messageAfter([](Glb& glb) { glb.extension()["version"] = 2; }), "2 is not known");
  expectSays(messageAfter([](Glb& glb) { glb.extension() = 7; }), "object");
  expectSays(messageAfter([](Glb& glb) { glb.extension().erase("visibility"); }), "visibility: missing");
  expectSays(messageAfter([](Glb& glb) { glb.extension().erase("indirect"); }), "indirect: missing");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["visibility"] = 99; }), "99");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["size"] = {3, 4, 3}; }), "were expected");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["size"] = {4096, 4096, 4096}; }), "were expected");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["size"] = {3, 4}; }), "three numbers");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["size"] = {3, 4, 1}; }), "1 is not a whole number");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["spacing"] = {1, 0, 1}; }), "spacing");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["lightOrder"] = 4; }), "lightOrder");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["format"] = "double"; }), "format");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["format"] = "half"; }), "component type 5123");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["bounces"] = 0; }), "there are no bounces");
  expectSays(messageAfter([](Glb& glb) {
               const Json& accessor = glb.json["accessors"][glb.extension()["visibility"].get<std::size_t>()];
               const Json& view = glb.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
               const float bad = NAN;
               std::memcpy(&glb.binary[view.value("byteOffset", std::size_t(0)) + 20], &bad, 4);
             }),
             "element 5 of accessors");
}

}  // namespace
}  // namespace gloam
