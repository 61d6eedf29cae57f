// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Volumes on their way in and out: raw grids, OpenVDB, GLOAM_volume; and where they stand.
#include <gloam/volume.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "scene/builtin_scenes.h"
#include "scene/glb_test_file.h"
#include "scene/gltf_volume.h"
#include "scene/half_float.h"
#include "scene/volume_files.h"
#include "scene/volume_places.h"

#if GLOAM_HAS_OPENVDB
#include <openvdb/openvdb.h>
#endif

namespace gloam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

fs::path temporary(const char* name) {
  return fs::temp_directory_path() / name;
}

Volume someVolume(int bounces) {
  Volume volume;
  volume.name = "smoke";
  volume.size = {3, 4, 2};
  volume.bounds_min = {-1.5f, 0.25f, -2.0f};
  volume.bounds_max = {0.5f, 1.25f, 3.0f};
  volume.albedo = {0.9f, 0.8f, 0.7f};
  volume.asymmetry = 0.25f;
  for (int i = 0; i < 24; ++i) volume.density.push_back(0.1f * float(i));
  if (bounces < 0) return volume;
  Transfer transfer;
  transfer.order = 3;
  transfer.bounces = bounces;
  transfer.directions = 100;
  for (int i = 0; i < 24 * 9; ++i) transfer.direct.push_back(std::sin(float(i)));
  for (int i = 0; i < 24 * 27 && bounces > 0; ++i) transfer.indirect.push_back(std::cos(float(i)));
  volume.transfer = std::make_shared<Transfer>(transfer);
  return volume;
}

Scene carryingScene(int bounces) {
  Scene scene = makeBuiltinScene("furnace?detail=0.25");
  scene.nodes[0].volume = std::make_shared<Volume>(someVolume(bounces));
  return scene;
}

std::vector<float> asHalves(std::vector<float> values) {
  for (float& v : values) v = floatFromHalf(halfFromFloat(v));
  return values;
}

std::string messageOf(const std::string& name) {
  try {
    loadScene(name);
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "no error";
}

TEST(VolumeFile, ComesBackExactlyAsFloatsAndRoundedAsHalves) {
  const fs::path path = temporary("gloam_volume_test.glb");
  for (const int bounces : {-1, 0, 2}) {
    for (const bool half_float : {false, true}) {
      const Scene scene = carryingScene(bounces);
      writeGlb(scene, path, {half_float});
      const Scene again = loadScene(path.string());
      ASSERT_TRUE(again.nodes[0].volume);
      const Volume &a = *scene.nodes[0].volume, &b = *again.nodes[0].volume;
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.size, b.size);
      EXPECT_EQ(a.bounds_min, b.bounds_min);
      EXPECT_EQ(a.bounds_max, b.bounds_max);
      EXPECT_EQ(a.albedo, b.albedo);
      EXPECT_EQ(a.asymmetry, b.asymmetry);
      EXPECT_EQ(b.density, half_float ? asHalves(a.density) : a.density);
      ASSERT_EQ(b.transfer != nullptr, bounces >= 0);
      if (bounces < 0) continue;
      EXPECT_EQ(b.transfer->order, 3);
      EXPECT_EQ(b.transfer->bounces, bounces);
      EXPECT_EQ(b.transfer->direct, half_float ? asHalves(a.transfer->direct) : a.transfer->direct);
      EXPECT_EQ(b.transfer->indirect, half_float ? asHalves(a.transfer->indirect) : a.transfer->indirect);
    }
  }
  fs::remove(path);
}

struct Glb : test::GlbChunks {
  Json& extension() { return json["nodes"][0]["extensions"][kVolumeExtension]; }
  char* numbers(const char* name) {
    const Json& accessor = json["accessors"][extension()[name].get<std::size_t>()];
    const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    return &binary[view.value("byteOffset", std::size_t(0))];
  }
};

/// Writes a volume, breaks it, and gives what the reader says.
std::string messageAfter(const std::function<void(Glb&)>& breakIt) {
  const fs::path path = temporary("gloam_volume_broken.glb");
  writeGlb(carryingScene(1), path);
  Glb glb{test::readGlbChunks(path)};
  breakIt(glb);
  test::writeGlbChunks(glb, path);
  const std::string message = messageOf(path.string());
  fs::remove(path);
  return message;
}

TEST(VolumeFile, BadFilesAreAnswered) {
  const auto expectSays = [](const std::string& message, const char* what) {
    EXPECT_NE(message.find(what), std::string::npos) << message;
    EXPECT_NE(message.find("nodes[0].extensions.GLOAM_volume"), std::string::npos) << message;
  };
  expectSays(messageAfter([](Glb& glb) { glb.extension()["version"] = 2; }), "2 is not known");
  expectSays(messageAfter([](Glb& glb) { glb.extension() = 7; }), "object");
  expectSays(messageAfter([](Glb& glb) { glb.extension().erase("density"); }), "density: missing");
  expectSays(messageAfter([](Glb& glb) { glb.extension().erase("albedo"); }), "albedo: missing");
  expectSays(messageAfter([](Glb& glb) { glb.extension().erase("asymmetry"); }), "asymmetry: missing");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["asymmetry"] = 1; }), "asymmetry of 1");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["albedo"] = {0.5, 2, 0.5}; }), "albedo of 2");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["albedo"] = "white"; }), "three numbers");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["boundsMax"] = {-9, 9, 9}; }), "room between");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["size"] = {3, 4, 1}; }), "1 is not a whole number");
  expectSays(messageAfter([](Glb& glb) {
               glb.extension()["size"] = {3, 4, 2.5};
             }),
             "2.5 is not a whole number");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["size"] = {3, 4, 3}; }), "36 were expected");
  expectSays(messageAfter([](Glb& glb) {
               glb.extension()["size"] = {65536, 65536, 65536};
             }),
             "were expected");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["format"] = "half"; }), "component type 5123");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["transfer"]["order"] = 9; }), "transfer.order");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["transfer"]["bounces"] = 0; }),
             "there are no bounces");
  expectSays(messageAfter([](Glb& glb) { glb.extension()["transfer"].erase("indirect"); }),
             "indirect: missing");
  const auto put = [](Glb& glb, float value) { std::memcpy(glb.numbers("density") + 20, &value, 4); };
  expectSays(messageAfter([&](Glb& glb) { put(glb, NAN); }), "element 5 of accessors");
  expectSays(messageAfter([&](Glb& glb) { put(glb, -1.0f); }), "voxel 5: a density of -1");
}

TEST(VolumeFile, RawGridsOfEveryTypeAreRead) {
  const fs::path path = temporary("gloam_volume_test.raw");
  const auto expectRead = [&](const auto& values, const char* type, float full) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()),
               std::streamsize(sizeof(values[0]) * values.size()));
    const Scene scene =
        loadScene(path.string() + "?size=2x2x3&longest=6&density=2&albedo=0.5&g=-0.25&type=" + type);
    const std::vector<PlacedVolume> placed = VolumePlaces(scene).at(0.0f);
    ASSERT_EQ(placed.size(), 1u);
    const Volume& volume = *placed[0].volume;
    EXPECT_EQ(volume.size, glm::ivec3(2, 2, 3));
    EXPECT_EQ(volume.name, "gloam_volume_test");
    EXPECT_NEAR(glm::length(volume.bounds_max - glm::vec3(4, 4, 6)), 0.0f, 1e-5f);
    EXPECT_EQ(volume.albedo, glm::vec3(0.5f));
    EXPECT_EQ(volume.asymmetry, -0.25f);
    for (std::size_t i = 0; i < 12; ++i)
      EXPECT_NEAR(volume.density[i], 2.0f * float(values[i]) / full, 1e-5f);
    EXPECT_EQ(pose(scene, 0.0f).cameras.size(), 1u);
    EXPECT_FALSE(scene.meshes.empty());
    EXPECT_TRUE(scene.warnings.empty());
  };
  std::vector<std::uint8_t> bytes(12);
  std::vector<std::uint16_t> shorts(12);
  std::vector<float> floats(12);
  for (std::size_t i = 0; i < 12; ++i)
    bytes[i] = std::uint8_t(20 * i), shorts[i] = std::uint16_t(5000 * i), floats[i] = 0.5f * float(i);
  expectRead(bytes, "u8", 255.0f);
  expectRead(shorts, "u16", 65535.0f);
  expectRead(floats, "f32", 1.0f);
  std::ofstream(path, std::ios::binary) << std::string(12, '\0');
  const Scene nothing = loadScene(path.string() + "?size=2x2x3&type=u8");
  ASSERT_EQ(nothing.warnings.size(), 1u);
  EXPECT_NE(nothing.warnings[0].find("density is 0"), std::string::npos);
  fs::remove(path);
}

TEST(VolumeFile, RawGridsThatDoNotFitAreAnswered) {
  const fs::path path = temporary("gloam_volume_bad.raw");
  std::ofstream(path) << "eightby8";
  const auto expectSays = [&](const std::string& values, const char* what) {
    const std::string message = messageOf(path.string() + values);
    EXPECT_NE(message.find(what), std::string::npos) << message;
  };
  expectSays("", "size=64x64x64");
  expectSays("?size=2x2", "size=64x64x64");
  expectSays("?size=2x2x2x2", "size=64x64x64");
  expectSays("?size=2x2x1", "2 to 4096");
  expectSays("?size=2x2x3", "8 bytes; 2 x 2 x 3 voxels of type u8 are 12");
  expectSays("?size=4096x4096x4096", "are 68719476736");
  expectSays("?size=2x2x2&type=u32", "u8, u16 or f32");
  expectSays("?size=2x2x2&albedo=2", "albedo: '2'");
  expectSays("?size=2x2x2&longest=nan", "longest: 'nan'");
  expectSays("?size=2x2x2&size=2x2x2", "stands twice");
  expectSays("?size=2x2x2&colour=1", "'colour' is not known");
  expectSays("?size", "key=value");
  std::ofstream(path, std::ios::binary) << std::string("\0\0\xc0\x7f", 4) << std::string(28, '\0');
  expectSays("?size=2x2x2&type=f32", "voxel 0: a density of nan");
  fs::remove(path);
  expectSays("?size=2x2x2", path.filename().c_str());
}

TEST(VolumeFile, OpenVdbIsReadWhereItIsInstalled) {
  const fs::path path = temporary("gloam_volume_test.vdb");
#if GLOAM_HAS_OPENVDB
  openvdb::initialize();
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
  grid->setName("density");
  for (int z = 0; z < 6; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x) grid->tree().setValue({x - 3, y, z}, float(x + 1));
  openvdb::io::File(path.string()).write({grid});
  const auto volumeOf = [&](const std::string& values) {
    return *VolumePlaces(loadScene(path.string() + values)).at(0.0f)[0].volume;
  };
  const Volume whole = volumeOf("?longest=4&density=32");
  EXPECT_EQ(whole.size, glm::ivec3(16, 8, 6));
  EXPECT_NEAR(glm::length(whole.bounds_max - glm::vec3(4, 2, 1.5)), 0.0f, 1e-5f);
  EXPECT_FLOAT_EQ(whole.density[5], 12.0f);
  const Volume coarse = volumeOf("?cells=8&density=32");
  EXPECT_EQ(coarse.size, glm::ivec3(8, 4, 3));
  EXPECT_NEAR(coarse.density[1], 32.0f * 3.5f / 15.5f, 1e-3f);  // between voxels 3 and 4; the densest is 15.5
  EXPECT_NE(messageOf(path.string() + "?grid=heat").find("there are density"), std::string::npos);
  std::ofstream(path) << "no grid at all";
  EXPECT_NE(messageOf(path.string()).find(path.filename()), std::string::npos);
#else
  std::ofstream(path) << "whatever";
  EXPECT_NE(messageOf(path.string()).find("without OpenVDB"), std::string::npos);
#endif
  fs::remove(path);
}

TEST(VolumePlaces, FollowNodesAndTheirAnimation) {
  Scene scene = carryingScene(-1);
  scene.nodes[0].translation = {1, 2, 3};
  AnimationChannel channel;
  channel.node = 0;
  channel.path = AnimationChannel::Path::kTranslation;
  channel.times_s = {0, 2};
  channel.values = {0, 0, 0, 4, 0, 0};
  scene.animations.push_back({"slide", {channel}});
  const VolumePlaces places(scene);
  ASSERT_EQ(places.at(1.0f).size(), 1u);
  EXPECT_EQ(places.at(1.0f)[0].node, 0);
  EXPECT_NEAR(glm::length(glm::vec3(places.at(1.0f)[0].world_from_node[3]) - glm::vec3(2, 0, 0)), 0.0f,
              1e-5f);
  scene.roots.clear();
  EXPECT_TRUE(VolumePlaces(scene).at(0.0f).empty());
  EXPECT_TRUE(VolumePlaces(makeBuiltinScene("furnace?detail=0.25")).at(0.0f).empty());
}

TEST(VolumePlaces, TheCloudIsThereAndThick) {
  const Scene scene = makeBuiltinScene("cloud?detail=0.5");
  ASSERT_TRUE(carriesVolumes(scene));
  EXPECT_TRUE(carriesUnbakedVolumes(scene));
  EXPECT_EQ(volumeNames(scene), "cloud");
  const Volume& cloud = *VolumePlaces(scene).at(0.0f)[0].volume;
  std::size_t filled = 0, rim = 0;
  for (std::size_t i = 0; i < cloud.voxels(); ++i) {
    filled += cloud.density[i] > 0.5f;
    const int x = int(i) % cloud.size.x, y = int(i) / cloud.size.x % cloud.size.y;
    rim += (x == 0 || x + 1 == cloud.size.x || y == 0) && cloud.density[i] > 0.5f;
  }
  EXPECT_GT(filled, cloud.voxels() / 10);
  EXPECT_LT(filled, cloud.voxels() / 2);
  EXPECT_EQ(rim, 0u) << "cut off by its box";
}

}  // namespace
}  // namespace gloam
