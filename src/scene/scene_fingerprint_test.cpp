// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/scene_fingerprint.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <set>

#include "scene/builtin_scenes.h"
#include "scene/checkpoint_file.h"

namespace gloam {
namespace {

template <class T>
std::string printOf(const T& value) {
  Fingerprint print;
  add(print, value);
  return print.text();
}

TEST(SceneFingerprint, ChangesWithAnythingInTheSceneButItsWarnings) {
  const Scene scene = makeBuiltinScene("walker?detail=0.25");
  ASSERT_FALSE(scene.animations.empty());
  ASSERT_FALSE(scene.skins.empty());
  std::set<std::string> prints{printOf(scene)};
  std::size_t expected = 1;
  const auto changed = [&](const std::function<void(Scene&)>& change) {
    Scene other = scene;
    change(other);
    EXPECT_TRUE(prints.insert(printOf(other)).second) << "change " << expected;
    ++expected;
  };
  changed([](Scene& s) { s.name += "x"; });
  changed([](Scene& s) { s.materials[0].roughness += 0.001f; });
  changed([](Scene& s) { s.materials[0].emission_map.texture_from_uv[1][1] = 2.0f; });
  changed([](Scene& s) { s.meshes[0].positions[0].x = std::nextafter(s.meshes[0].positions[0].x, 9.0f); });
  changed([](Scene& s) { std::swap(s.meshes[0].indices[0], s.meshes[0].indices[1]); });
  changed([](Scene& s) { s.meshes[0].transfer = std::make_shared<Transfer>(); });
  changed([](Scene& s) { s.nodes[0].scale.y = 2.0f; });
  changed([](Scene& s) { s.nodes[0].matrix = glm::mat4(1.0f); });
  changed([](Scene& s) { s.animations[0].channels[0].times_s.back() += 1.0f; });
  changed([](Scene& s) { s.skins[0].joint_from_mesh[0][3][0] += 1.0f; });
  changed([](Scene& s) { s.lights.emplace_back(); });
  changed([](Scene& s) { s.cameras.emplace_back(); });
  changed([](Scene& s) { s.textures.push_back({"t", 1, 1, {1, 2, 3, 4}}); });
  Scene same = scene;
  same.warnings.push_back("mended");
  EXPECT_EQ(printOf(same), printOf(scene));
}

TEST(SceneFingerprint, ChangesWithPoseCameraAndLight) {
  const Scene scene = makeBuiltinScene("walker?detail=0.25");
  const PosedScene posed = pose(scene, 0.0f);
  EXPECT_NE(printOf(posed), printOf(pose(scene, 0.1f)));
  EXPECT_EQ(printOf(posed), printOf(pose(scene, 0.0f)));
  PosedCamera camera;
  const std::string before = printOf(camera);
  camera.world_from_view[3].x = 1.0f;
  EXPECT_NE(printOf(camera), before);
  Environment sky = loadEnvironment("sky:mild");
  const std::string mild = printOf(sky);
  sky.rotation_rad = 0.5f;
  EXPECT_NE(printOf(sky), mild);
}

TEST(SceneFingerprint, SizesCount) {
  Fingerprint a, b, c, d;
  addAll(a, std::string("ab"), std::string("c"));
  addAll(b, std::string("a"), std::string("bc"));
  EXPECT_NE(a.text(), b.text());
  add(c, std::vector<float>{});
  EXPECT_NE(c.text(), d.text());
  EXPECT_EQ(c.text().size(), 32u);
}

struct CheckpointFile : testing::Test {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "gloam_checkpoint_file_test";
  const CheckpointKind kind{{'t', 'e', 's', 't', 't', 'e', 's', 't'}, 3, "a test"};
  Fingerprint print;
  void SetUp() override {
    add(print, 1);
    CheckpointWriter writer(path, kind, print);
    const std::vector<int> numbers{1, 2, 3};
    writer.write(numbers.data(), sizeof(int) * numbers.size());
    writer.commit();
  }
  void TearDown() override { std::filesystem::remove(path); }
  std::string errorOfReading(const CheckpointKind& as, const Fingerprint& with) const {
    try {
      CheckpointReader reader(path, as, with);
      std::vector<int> numbers(3);
      reader.read(numbers.data(), sizeof(int) * numbers.size());
      reader.finish();
      EXPECT_EQ(numbers, (std::vector<int>{1, 2, 3}));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  static bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }
};

TEST_F(CheckpointFile, ComesBackOrSaysWhyNot) {
  EXPECT_EQ(errorOfReading(kind, print), "");
  CheckpointKind other = kind;
  other.version = 4;
  EXPECT_TRUE(has(errorOfReading(other, print), "another version"));
  other = kind;
  other.magic[0] = 'x';
  EXPECT_TRUE(has(errorOfReading(other, print), "is not a checkpoint of a test"));
  EXPECT_TRUE(has(errorOfReading(kind, Fingerprint()), "another scene"));
}

TEST_F(CheckpointFile, AnyDamagedByteIsNoticed) {
  const auto size = std::filesystem::file_size(path);
  std::vector<char> bytes(size);
  std::ifstream(path, std::ios::binary).read(bytes.data(), std::streamsize(size));
  for (std::size_t at = 0; at < size; ++at) {
    std::vector<char> damaged = bytes;
    damaged[at] = char(damaged[at] ^ 0x10);
    std::ofstream(path, std::ios::binary).write(damaged.data(), std::streamsize(size));
    EXPECT_THROW(
        {
          CheckpointReader reader(path, kind, print);
          std::vector<int> numbers(3);
          reader.read(numbers.data(), sizeof(int) * numbers.size());
          reader.finish();
        },
        Error)
        << at;
  }
  for (std::size_t length = 0; length < size; ++length) {
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(length));
    EXPECT_NE(errorOfReading(kind, print), "") << length;
  }
}

}  // namespace
}  // namespace gloam
