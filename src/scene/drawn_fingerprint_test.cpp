// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/drawn_fingerprint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "scene/builtin_scenes.h"
#include "scene/gltf_test_files.h"

namespace gloam {
namespace {

using DrawnFingerprintTest = test::SceneFileTest;

std::string printOf(const Scene& scene, float time_s = 0.0f) {
  return drawnFingerprint(scene, pose(scene, time_s)).text();
}

// A reference of the one is a reference of the other.
TEST_F(DrawnFingerprintTest, WhatIsWrittenIsDrawnTheSameBitForBit) {
  for (const BuiltinScene& known : builtinScenes()) {
    SCOPED_TRACE(std::string(known.name));
    const Scene scene = makeBuiltinScene(std::string(known.name) + "?detail=0.5");
    const std::string file = path("again.glb").string();
    writeGlb(scene, file);
    const Scene again = loadScene(file);
    for (const float time_s : {0.0f, 0.7f}) EXPECT_EQ(printOf(scene, time_s), printOf(again, time_s));
    EXPECT_EQ(drawnFingerprint(scene.environment), drawnFingerprint(again.environment));
    const PosedScene posed = pose(scene, 0.0f), posed_again = pose(again, 0.0f);
    ASSERT_EQ(posed.cameras.size(), posed_again.cameras.size());
    for (std::size_t i = 0; i < posed.cameras.size(); ++i)
      EXPECT_EQ(drawnFingerprint(posed.cameras[i]), drawnFingerprint(posed_again.cameras[i]));
  }
}

// Strengths that no power of two divides: colours come through a file as they were.
TEST_F(DrawnFingerprintTest, BrightColoursSurviveAFile) {
  Scene scene = makeBuiltinScene("lamp?detail=0.25");
  for (int i = 1; i < 200; ++i) {
    const float f = float(i);
    scene.materials[0].emission = {0.37f * f, 0.0113f * f, std::sqrt(f)};
    scene.lights[0].intensity = {std::sqrt(f), 3.0f / f, 0.071f * f};
    writeGlb(scene, path("a.glb"));
    const Scene again = loadScene(path("a.glb").string());
    ASSERT_EQ(again.materials[0].emission, scene.materials[0].emission) << i;
    ASSERT_EQ(again.lights[0].intensity, scene.lights[0].intensity) << i;
  }
}

TEST(DrawnFingerprint, ChangesWithWhatIsSeenAlone) {
  const Scene scene = makeBuiltinScene("textured?detail=0.25");
  std::set<std::string> prints{printOf(scene)};
  std::size_t change = 0;
  const auto printAfter = [&](const std::function<void(Scene&)>& bend) {
    Scene other = scene;
    bend(other);
    ++change;
    return printOf(other);
  };
  const auto seen = [&](const std::function<void(Scene&)>& bend) {
    EXPECT_TRUE(prints.insert(printAfter(bend)).second) << "change " << change;
  };
  const auto unseen = [&](const std::function<void(Scene&)>& bend) {
    EXPECT_EQ(printAfter(bend), printOf(scene)) << "change " << change;
  };
  const auto shown = [](Scene& s) -> Material& {
    return *std::ranges::find_if(s.materials, [](const Material& m) { return bool(m.base_color_map); });
  };
  seen([](Scene& s) { s.materials[0].base_color.r *= 0.999f; });
  seen([](Scene& s) { s.meshes[0].positions[0].x = std::nextafter(s.meshes[0].positions[0].x, 9.0f); });
  seen([](Scene& s) { s.meshes[0].normals[0] = -s.meshes[0].normals[0]; });
  seen([](Scene& s) { s.nodes[std::size_t(s.roots.front())].translation.y += 1e-4f; });
  seen([&](Scene& s) { s.textures[std::size_t(shown(s).base_color_map.texture)].rgba[0] ^= 1; });
  seen([&](Scene& s) { shown(s).base_color_map.texture_from_uv[0][0] *= 2.0f; });
  seen([&](Scene& s) { shown(s).base_color_map = {}; });
  seen([](Scene& s) {
    int& material = s.meshes.back().material;
    material = material > 0 ? 0 : 1;
  });
  unseen([](Scene& s) { s.textures.push_back({"spare", 1, 1, {1, 2, 3, 4}}); });
  unseen([](Scene& s) { s.textures[0].name = s.materials[0].name = s.meshes[0].name = "other"; });
  unseen([](Scene& s) {
    s.textures.insert(s.textures.begin(), Texture{"spare", 1, 1, {1, 2, 3, 4}});
    for (Material& m : s.materials) {
      for (TextureSlot* slot :
           {&m.base_color_map, &m.metallic_roughness_map, &m.normal_map, &m.occlusion_map, &m.emission_map})
        if (*slot) ++slot->texture;
    }
  });
}

}  // namespace
}  // namespace gloam
