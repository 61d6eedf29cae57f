// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/scene.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "scene/builtin_scenes.h"
#include "scene/builtin_shapes.h"
#include "scene/glb_builder.h"
#include "scene/painted_textures.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;

/// Where GLOAM_KEEP_WRITTEN names a folder the files stay there, for other programs to look at.
fs::path temporary(const std::string& name) {
  const char* kept = std::getenv("GLOAM_KEEP_WRITTEN");
  return (kept ? fs::path(kept) : fs::temp_directory_path()) / ("gloam_write_test_" + name + ".glb");
}
void removeUnlessKept(const fs::path& path) {
  if (!std::getenv("GLOAM_KEEP_WRITTEN")) fs::remove(path);
}

Scene roundTrip(const Scene& scene, const std::string& name, const WriteOptions& options = {}) {
  const fs::path path = temporary(name);
  writeGlb(scene, path, options);
  Scene again = loadScene(path.string());
  removeUnlessKept(path);
  return again;
}

template <typename Matrix>
float difference(const Matrix& a, const Matrix& b) {
  float sum = 0.0f;
  for (int c = 0; c < Matrix::length(); ++c) sum += glm::length(a[c] - b[c]);
  return sum;
}

void expectEqual(const TextureSlot& a, const TextureSlot& b, const Scene& scene_a, const Scene& scene_b) {
  ASSERT_EQ(bool(a), bool(b));
  if (!a) return;
  EXPECT_EQ(a.uv_set, b.uv_set);
  EXPECT_EQ(a.wrap_u, b.wrap_u);
  EXPECT_EQ(a.wrap_v, b.wrap_v);
  EXPECT_EQ(a.nearest, b.nearest);
  EXPECT_LT(difference(a.texture_from_uv, b.texture_from_uv), 1e-5f);
  const Texture &ta = scene_a.textures[std::size_t(a.texture)],
                &tb = scene_b.textures[std::size_t(b.texture)];
  EXPECT_EQ(ta.name, tb.name);
  EXPECT_EQ(ta.width, tb.width);
  EXPECT_TRUE(ta.rgba == tb.rgba);
}

void expectEqual(const Material& a, const Material& b, const Scene& scene_a, const Scene& scene_b) {
  SCOPED_TRACE(a.name);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.base_color, b.base_color);
  EXPECT_EQ(a.metallic, b.metallic);
  EXPECT_EQ(a.roughness, b.roughness);
  EXPECT_EQ(a.specular, b.specular);
  EXPECT_LT(glm::length(a.emission - b.emission), 1e-5f * (1.0f + glm::length(a.emission)));
  EXPECT_EQ(a.alpha_mask, b.alpha_mask);
  EXPECT_EQ(a.alpha_cutoff, b.alpha_cutoff);
  EXPECT_EQ(a.double_sided, b.double_sided);
  EXPECT_EQ(a.normal_scale, b.normal_scale);
  EXPECT_EQ(a.occlusion_strength, b.occlusion_strength);
  expectEqual(a.base_color_map, b.base_color_map, scene_a, scene_b);
  expectEqual(a.metallic_roughness_map, b.metallic_roughness_map, scene_a, scene_b);
  expectEqual(a.normal_map, b.normal_map, scene_a, scene_b);
  expectEqual(a.occlusion_map, b.occlusion_map, scene_a, scene_b);
  expectEqual(a.emission_map, b.emission_map, scene_a, scene_b);
}

void expectEqual(const Mesh& a, const Mesh& b, bool tangents) {
  SCOPED_TRACE(a.name);
  EXPECT_EQ(a.name, b.name);
  ASSERT_EQ(a.vertexCount(), b.vertexCount());
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_TRUE(a.uv_sets == b.uv_sets);
  EXPECT_TRUE(a.colors == b.colors);
  EXPECT_TRUE(a.indices == b.indices);
  EXPECT_TRUE(a.joints == b.joints);
  EXPECT_EQ(a.influences, b.influences);
  EXPECT_EQ(a.material, b.material);
  ASSERT_EQ(a.weights.size(), b.weights.size());
  for (std::size_t i = 0; i < a.weights.size(); ++i) ASSERT_NEAR(a.weights[i], b.weights[i], 1e-6f);
  for (std::size_t i = 0; i < a.vertexCount(); ++i) {
    ASSERT_LT(glm::length(a.normals[i] - b.normals[i]), 1e-6f);
    if (tangents) {
      ASSERT_LT(glm::length(a.tangents[i] - b.tangents[i]), 1e-6f);
    }
  }
  ASSERT_EQ(a.morph_targets.size(), b.morph_targets.size());
  for (std::size_t t = 0; t < a.morph_targets.size(); ++t) {
    EXPECT_TRUE(a.morph_targets[t].positions == b.morph_targets[t].positions);
    EXPECT_TRUE(a.morph_targets[t].normals == b.morph_targets[t].normals);
  }
}

void expectEqual(const Node& a, const Node& b) {
  SCOPED_TRACE(a.name);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.parent, b.parent);
  EXPECT_EQ(a.children, b.children);
  EXPECT_EQ(a.translation, b.translation);
  EXPECT_LT(glm::length(a.rotation - b.rotation), 1e-6f);
  EXPECT_EQ(a.scale, b.scale);
  EXPECT_EQ(a.matrix, b.matrix);
  EXPECT_EQ(a.meshes, b.meshes);
  EXPECT_EQ(a.skin, b.skin);
  EXPECT_EQ(a.camera, b.camera);
  EXPECT_EQ(a.light, b.light);
  EXPECT_EQ(a.morph_weights, b.morph_weights);
  ASSERT_EQ(a.instances.size(), b.instances.size());
  for (std::size_t i = 0; i < a.instances.size(); ++i)
    EXPECT_LT(difference(a.instances[i], b.instances[i]), 1e-5f);
}

void expectEqual(const Camera& a, const Camera& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.perspective, b.perspective);
  EXPECT_EQ(a.vertical_fov_rad, b.vertical_fov_rad);
  EXPECT_EQ(a.half_height, b.half_height);
  EXPECT_EQ(a.aspect, b.aspect);
  EXPECT_EQ(a.z_near, b.z_near);
  EXPECT_EQ(a.z_far, b.z_far);
}

void expectEqual(const Light& a, const Light& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.type, b.type);
  EXPECT_LT(glm::length(a.intensity - b.intensity), 1e-6f * glm::length(a.intensity));
  EXPECT_EQ(a.range, b.range);
  if (a.type != Light::Type::kSpot) return;
  EXPECT_FLOAT_EQ(a.inner_cone_rad, b.inner_cone_rad);
  EXPECT_FLOAT_EQ(a.outer_cone_rad, b.outer_cone_rad);
}

void expectEqual(const Scene& a, const Scene& b) {
  EXPECT_TRUE(b.warnings.empty()) << b.warnings[0];
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) expectEqual(a.materials[i], b.materials[i], a, b);
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    expectEqual(a.meshes[i], b.meshes[i], bool(a.materials[std::size_t(a.meshes[i].material)].normal_map));
  }
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) expectEqual(a.nodes[i], b.nodes[i]);
  EXPECT_EQ(a.roots, b.roots);
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  for (std::size_t i = 0; i < a.cameras.size(); ++i) expectEqual(a.cameras[i], b.cameras[i]);
  ASSERT_EQ(a.lights.size(), b.lights.size());
  for (std::size_t i = 0; i < a.lights.size(); ++i) expectEqual(a.lights[i], b.lights[i]);
  ASSERT_EQ(a.skins.size(), b.skins.size());
  for (std::size_t i = 0; i < a.skins.size(); ++i) {
    EXPECT_EQ(a.skins[i].joints, b.skins[i].joints);
    EXPECT_EQ(a.skins[i].joint_from_mesh, b.skins[i].joint_from_mesh);
  }
  ASSERT_EQ(a.animations.size(), b.animations.size());
  for (std::size_t i = 0; i < a.animations.size(); ++i) {
    const auto &channels_a = a.animations[i].channels, &channels_b = b.animations[i].channels;
    ASSERT_EQ(channels_a.size(), channels_b.size());
    for (std::size_t c = 0; c < channels_a.size(); ++c) {
      EXPECT_EQ(channels_a[c].node, channels_b[c].node);
      EXPECT_EQ(channels_a[c].path, channels_b[c].path);
      EXPECT_EQ(channels_a[c].interpolation, channels_b[c].interpolation);
      EXPECT_EQ(channels_a[c].components, channels_b[c].components);
      EXPECT_TRUE(channels_a[c].times_s == channels_b[c].times_s);
      EXPECT_TRUE(channels_a[c].values == channels_b[c].values);
    }
  }
  EXPECT_EQ(a.environment.name, b.environment.name);
  EXPECT_EQ(a.environment.intensity, b.environment.intensity);
  EXPECT_EQ(a.environment.rotation_rad, b.environment.rotation_rad);
  EXPECT_TRUE(a.environment.radiance == b.environment.radiance);
}

class WriteGlb : public testing::TestWithParam<BuiltinScene> {};

TEST_P(WriteGlb, BuiltinScenesComeBackAsTheyWere) {
  const Scene scene = makeBuiltinScene(std::string(GetParam().name) + "?detail=0.5");
  expectEqual(scene, roundTrip(scene, GetParam().name));
}

INSTANTIATE_TEST_SUITE_P(All, WriteGlb, testing::ValuesIn(builtinScenes()),
                         [](const testing::TestParamInfo<BuiltinScene>& info) {
                           std::string name = info.param.name;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

// One of everything that the format can say and the built-in scenes do not.
Scene oddScene() {
  SceneBuilder builder("odd");
  const int shiny = builder.glossy("emits", {0.1f, 0.2f, 0.3f}, 0.4f);
  Material& m = builder.material(shiny);
  m.specular = 0.25f;
  m.emission = {12.0f, 3.0f, 0.5f};
  m.alpha_mask = true;
  m.alpha_cutoff = 0.3f;
  const int map =
      builder.texture(paint("map", 5, 3, [](float u, float v) { return glm::vec4(u, v, 0.5f, u); }));
  m.base_color_map.texture = m.occlusion_map.texture = m.emission_map.texture = map;
  m.base_color_map.nearest = true;
  m.base_color_map.wrap_v = Wrap::kMirroredRepeat;
  m.base_color_map.texture_from_uv =
      glm::mat3(0.6f, 0.8f, 0, 1.6f, -1.2f, 0, 3, -4, 1);  // mirrored, turned, moved
  m.occlusion_map.uv_set = 1;
  m.occlusion_strength = 0.7f;
  const int dim = builder.diffuse("dim", glm::vec3(0.5f));
  builder.material(dim).emission = {0.25f, 0.5f, 0.125f};

  Mesh box = shapes::box({-1, -1, -1}, {1, 1, 1}, 0.5f);
  box.uv_sets.push_back(box.uv_sets[0]);
  box.colors.assign(box.vertexCount(), {0.5f, 0.25f, 1.0f, 0.75f});
  MorphTarget target;
  target.positions.assign(box.vertexCount(), {0, 1, 0});
  box.morph_targets = {target, target};
  const int first = builder.mesh("pair", box, shiny);
  const int second = builder.mesh("pair", box, dim);
  const int node = builder.node("pair", kNone, {1, 2, 3});
  builder.at(node).meshes = {first, second};
  builder.at(node).morph_weights = {0.0f, 0.25f};
  AnimationChannel& weights =
      builder.channel(node, AnimationChannel::Path::kWeights, AnimationChannel::Interpolation::kStep);
  weights.components = 2;
  weights.times_s = {0, 1};
  weights.values = {0, 0.25f, 1, 0};
  const int by_matrix = builder.node("by matrix");
  builder.at(by_matrix).matrix = glm::rotate(glm::translate(glm::mat4(1.0f), {3, 2, 1}), 0.3f, {1, 0, 0});
  const int child = builder.place("child", shapes::icosphere(1.0f, 2), dim, {0, 1, 0}, by_matrix);
  builder.at(child).scale = {1, -2, 0.5f};
  builder.at(child).rotation = glm::angleAxis(1.0f, glm::normalize(glm::vec3(1, 2, 3)));
  builder.at(child).instances = {glm::translate(glm::mat4(1.0f), {1, 0, 0}),
                                 glm::scale(glm::rotate(glm::mat4(1.0f), 0.5f, {0, 1, 0}), {1, 2, 3})};
  Light sun;
  sun.name = "sun";
  sun.type = Light::Type::kDirectional;
  sun.intensity = {3, 2, 0};
  builder.light(sun, {0, 0, 0}, {1, -1, 0});
  Light bulb;
  bulb.name = "bulb";
  bulb.range = 4;
  builder.light(bulb, {0, 1, 0});
  builder.camera({0, 0, 5}, {0, 0, 0}, 40);
  Scene scene = builder.finish();
  Camera flat;
  flat.name = "flat";
  flat.perspective = false;
  flat.half_height = 2.5f;
  flat.aspect = 1.5f;
  flat.z_far = 50.0f;
  scene.cameras.push_back(flat);
  return scene;
}

TEST(WriteGlb, OddThingsComeBackToo) {
  const Scene scene = oddScene();
  expectEqual(scene, roundTrip(scene, "odd"));
}

TEST(WriteGlb, PrimitivesOfOneMeshGetEqualNumbersOfMorphTargets) {
  Scene scene = oddScene();
  scene.meshes[1].morph_targets.clear();
  const Scene again = roundTrip(scene, "unequal");
  ASSERT_EQ(again.meshes[1].morph_targets.size(), 2u);
  for (const glm::vec3& d : again.meshes[1].morph_targets[0].positions) EXPECT_EQ(d, glm::vec3(0.0f));
}

TEST(WriteGlb, ShearedNodesBecomeTwoThatAreValid) {
  Scene scene = oddScene();
  glm::mat4 shear = glm::translate(glm::mat4(1.0f), {0.5f, 0.25f, -1});
  shear[1].x = 0.5f;
  shear[2] *= -2.0f;
  scene.nodes[1].matrix = shear;  // by matrix, a root
  scene.nodes[2].matrix = shear;  // its child, with instances
  const PosedScene before = pose(scene, 0.0f), after = pose(roundTrip(scene, "sheared"), 0.0f);
  ASSERT_EQ(before.instances.size(), after.instances.size());
  for (std::size_t i = 0; i < before.instances.size(); ++i) {
    EXPECT_LT(difference(before.instances[i].world_from_object, after.instances[i].world_from_object), 1e-4f);
  }
}

TEST(WriteGlb, AnEmptySceneIsAValidFile) {
  writeGlb(Scene{}, temporary("empty"));
  EXPECT_GT(fs::file_size(temporary("empty")), 20u);
  removeUnlessKept(temporary("empty"));
}

TEST(WriteGlb, WhatCannotBeWrittenIsAnErrorAndLeavesNothing) {
  const Scene scene = makeBuiltinScene("bowl?detail=0.25");
  EXPECT_THROW(writeGlb(scene, "/nowhere/at/all.glb"), Error);
  const fs::path folder = fs::temp_directory_path() / "gloam_write_test_folder";
  fs::create_directories(folder / "target.glb");  // a folder stands where the file should
  EXPECT_THROW(writeGlb(scene, folder / "target.glb"), Error);
  std::size_t left = 0;
  for (const auto& entry : fs::directory_iterator(folder)) left += entry.path().filename() != "target.glb";
  EXPECT_EQ(left, 0u);
  fs::remove_all(folder);
}

TEST(WriteGlb, FloatsAreWrittenShortAndReadBackExactly) {
  std::mt19937 random(5);
  for (int i = 0; i < 10000; ++i) {
    const float value = std::ldexp(float(random()) / 4294967296.0f - 0.5f, int(random() % 60) - 30);
    EXPECT_EQ(float(tidy(value)), value);
  }
  EXPECT_EQ(nlohmann::json(tidy(0.1f)).dump(), "0.1");
}

}  // namespace
}  // namespace gloam
