// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Materials, nodes, lights, cameras and animation of glTF files.
#include <gloam/sh.h>

#include <cmath>
#include <numbers>

#include "scene/gltf_test_files.h"

namespace gloam::test {
namespace {

using GltfContent = SceneFileTest;

GltfFile texturedSquare() {
  GltfFile file = squareFile();
  file.json["images"][0] = {
      {"mimeType", "image/png"}, {"bufferView", file.view(tinyPng())}, {"name", "paint"}};
  file.json["textures"][0] = {{"source", 0}, {"sampler", 0}};
  file.json["samplers"][0] = {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}};
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  file.json["materials"][0]["name"] = "wall";
  return file;
}

TEST_F(GltfContent, MaterialWithEveryTexture) {
  GltfFile file = texturedSquare();
  Json& m = file.json["materials"][0];
  m["pbrMetallicRoughness"] = {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                               {"metallicFactor", 0.25},
                               {"roughnessFactor", 0.75},
                               {"baseColorTexture", {{"index", 0}}},
                               {"metallicRoughnessTexture", {{"index", 0}}}};
  m["normalTexture"] = {{"index", 0}, {"scale", 0.5}};
  m["occlusionTexture"] = {{"index", 0}, {"strength", 0.6}};
  m["emissiveTexture"] = {{"index", 0}};
  m["emissiveFactor"] = {1.0, 0.5, 0.0};
  m["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 8;
  m["alphaMode"] = "MASK", m["alphaCutoff"] = 0.3, m["doubleSided"] = true;
  const Scene scene = loadScene(put("a.gltf", file.text()));
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.name, "wall");
  EXPECT_EQ(material.base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(material.metallic, 0.25f);
  EXPECT_EQ(material.roughness, 0.75f);
  EXPECT_EQ(material.emission, glm::vec3(8, 4, 0));
  EXPECT_EQ(material.normal_scale, 0.5f);
  EXPECT_EQ(material.occlusion_strength, 0.6f);
  EXPECT_TRUE(material.alpha_mask && material.double_sided);
  EXPECT_EQ(material.alpha_cutoff, 0.3f);
  for (const TextureSlot* slot : {&material.base_color_map, &material.metallic_roughness_map,
                                  &material.normal_map, &material.occlusion_map, &material.emission_map}) {
    EXPECT_EQ(slot->texture, 0);
    EXPECT_EQ(slot->wrap_u, Wrap::kClampToEdge);
    EXPECT_EQ(slot->wrap_v, Wrap::kMirroredRepeat);
    EXPECT_TRUE(slot->nearest);
  }
  ASSERT_EQ(scene.textures.size(), 1u);  // one picture, decoded once
  EXPECT_EQ(scene.textures[0].rgba, (Bytes{255, 0, 0, 255, 0, 255, 0, 128}));
  EXPECT_EQ(scene.textures[0].name, "paint");
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(GltfContent, BlendIsDrawnOpaqueAndSaid) {
  GltfFile file = texturedSquare();
  file.json["materials"][0]["alphaMode"] = "BLEND";
  const Scene scene = loadScene(put("a.gltf", file.text()));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0], "material 'wall': alphaMode BLEND is drawn opaque");
  EXPECT_FALSE(scene.materials[0].alpha_mask);
}

TEST_F(GltfContent, PicturesFromUrisAndFiles) {
  GltfFile file = texturedSquare();
  file.json["materials"][0]["emissiveTexture"]["index"] = 0;
  file.json["images"][0] = {{"uri", "data:image/png;base64," + base64(tinyPng())}};
  EXPECT_EQ(loadScene(put("a.gltf", file.text())).textures.at(0).width, 2);
  put("blue sky.png", tinyPng());
  file.json["images"][0] = {{"uri", "blue%20sky.png"}};
  EXPECT_EQ(loadScene(put("a.gltf", file.text())).textures.at(0).name, "blue sky.png");
  file.json["images"][0] = {{"uri", "none.png"}};
  EXPECT_NE(refusal(put("a.gltf", file.text())).find("images[0].uri: "), std::string::npos);
}

TEST_F(GltfContent, UnusedPicturesAreNotRead) {
  GltfFile file = texturedSquare();  // no material slot uses the texture
  file.json["images"][0] = {{"uri", "none.png"}};
  EXPECT_TRUE(loadScene(put("a.gltf", file.text())).textures.empty());
}

TEST_F(GltfContent, TextureTransformTakesTheLowerLeftQuadrantAsItsSpecificationSays) {
  GltfFile file = texturedSquare();
  // "Only the lower left quadrant of the source image, rotated clockwise 90 degrees": offset (0, 1), scale one half.
  file.json["materials"][0]["emissiveTexture"] = {
      {"index", 0},
      {"extensions",
       {{"KHR_texture_transform",
         {{"offset", {0, 1}}, {"rotation", std::numbers::pi / 2}, {"scale", {0.5, 0.5}}, {"texCoord", 0}}}}}};
  const Scene scene = loadScene(put("a.gltf", file.text()));
  const glm::mat3& m = scene.materials[0].emission_map.texture_from_uv;
  for (const glm::vec2 uv : {glm::vec2(0.01f, 0.01f), glm::vec2(0.99f, 0.01f), glm::vec2(0.5f, 0.99f)}) {
    const glm::vec3 at = m * glm::vec3(uv, 1.0f);
    EXPECT_TRUE(at.x > 0.0f && at.x < 0.5f) << at.x;  // left half
    EXPECT_TRUE(at.y > 0.5f && at.y < 1.0f) << at.y;  // lower half, v being down
  }
}

TEST_F(GltfContent, SpecularGlossinessBecomesMetallicRoughness) {
  GltfFile file = texturedSquare();
  Json& extension = file.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"];
  extension = {{"diffuseFactor", {0.5, 0.25, 0.125, 1}},
               {"specularFactor", {0.04, 0.04, 0.04}},
               {"glossinessFactor", 0.7}};
  Material m = loadScene(put("a.gltf", file.text())).materials.at(0);
  EXPECT_NEAR(m.metallic, 0.0f, 1e-4f);
  EXPECT_NEAR(m.roughness, 0.3f, 1e-6f);
  EXPECT_NEAR(m.base_color.r, 0.5f, 1e-3f);
  EXPECT_NEAR(m.base_color.b, 0.125f, 1e-3f);
  extension = {{"diffuseFactor", {0, 0, 0, 1}}, {"specularFactor", {1.0, 0.8, 0.3}}, {"glossinessFactor", 1}};
  m = loadScene(put("a.gltf", file.text())).materials.at(0);  // gold
  EXPECT_NEAR(m.metallic, 1.0f, 1e-3f);
  EXPECT_NEAR(m.base_color.g, 0.8f, 1e-3f);
  extension = {{"specularGlossinessTexture", {{"index", 0}}}};
  const Scene scene = loadScene(put("a.gltf", file.text()));
  ASSERT_EQ(scene.textures.size(), 2u);  // glossiness 1 and 128/255 became roughness 0 and 127/255 in green
  EXPECT_EQ(scene.textures[1].rgba[1], 0);
  EXPECT_EQ(scene.textures[1].rgba[5], 127);
}

TEST_F(GltfContent, NodesTransformAndInstance) {
  GltfFile file = triangleFile();
  file.json["nodes"][0]["translation"] = {1, 2, 3};
  file.json["nodes"][0]["scale"] = {2, 2, 2};
  file.json["nodes"][0]["rotation"] = {0, 2, 0, 0};  // not a unit: half a turn about y
  const int t = file.accessor<float>({0, 0, 0, 10, 0, 0}, "VEC3");
  const int r = file.accessor<std::int16_t>({0, 0, 0, 32767, 0, 32767, 0, 0}, "VEC4", true);
  file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", t},
                                                                                  {"ROTATION", r}};
  file.show({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}, {"children", {2}}});
  file.add("nodes", {{"mesh", 0}});
  const Scene scene = loadScene(put("a.gltf", file.text()));
  const PosedScene posed = pose(scene, 0.0f);
  ASSERT_EQ(posed.instances.size(), 3u);
  const auto corner = [&](std::size_t i) {
    return posed.instances[i].world_from_object * glm::vec4(1, 0, 0, 1);
  };
  const auto near = [](const glm::vec4& a, const glm::vec3& b) {
    return glm::length(glm::vec3(a) - b) < 1e-4f;
  };
  EXPECT_TRUE(near(corner(0), {-1, 2, 3}));
  EXPECT_TRUE(
      near(corner(1), {1 - 2 * (10 - 1), 2, 3}));  // the instance turns and moves first, then the node
  EXPECT_TRUE(near(corner(2), {6, 6, 7}));
}

TEST_F(GltfContent, HiddenNodesShowNothing) {
  GltfFile file = triangleFile();
  file.show({{"children", {2}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  file.add("nodes", {{"mesh", 0}});
  EXPECT_EQ(pose(loadScene(put("a.gltf", file.text())), 0.0f).instances.size(), 1u);
}

TEST_F(GltfContent, CamerasAndLights) {
  GltfFile file = triangleFile();
  file.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"aspectRatio", 2}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}}};
  file.show({{"camera", 0}}), file.show({{"camera", 1}});
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 10}, {"range", 3}},
      {{"type", "moon"}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}},
      {{"type", "directional"}}};
  for (int i = 0; i < 4; ++i) file.show({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  const Scene scene = loadScene(put("a.gltf", file.text()));
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].vertical_fov_rad, 0.5f);
  EXPECT_TRUE(std::isinf(scene.cameras[0].z_far));
  EXPECT_FALSE(scene.cameras[1].perspective);
  EXPECT_EQ(scene.cameras[1].half_height, 2.0f);
  EXPECT_EQ(scene.cameras[1].aspect, 2.0f);
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(10, 5, 0));
  EXPECT_EQ(scene.lights[1].outer_cone_rad, 0.4f);
  EXPECT_EQ(scene.nodes[4].light, kNone);  // the moon
  EXPECT_EQ(scene.nodes[5].light, 1);
  EXPECT_TRUE(warned(scene, "'moon' is left out"));
}

TEST_F(GltfContent, ImageLightIsTurnedBackIntoRadiance) {
  GltfFile file = triangleFile();
  // A sky of radiance 1 + y: irradiance coefficients are its own times A_l.
  const auto one = static_cast<float>(std::sqrt(4.0 * std::numbers::pi) * sh::clampedCosineFactor(0));
  const auto y = static_cast<float>(std::sqrt(4.0 * std::numbers::pi / 3.0) * sh::clampedCosineFactor(1));
  Json coefficients = Json::array();
  for (int i = 0; i < 9; ++i)
    coefficients.push_back(Json::array({i == 0 ? one : i == 1 ? y : 0.0f, 0.0f, 0.0f}));
  file.json["extensions"]["EXT_lights_image_based"]["lights"][0] = {
      {"irradianceCoefficients", coefficients},
      {"intensity", 3},
      {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}};
  file.json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  const Scene scene = loadScene(put("a.gltf", file.text()));
  // The rotation takes +Y to -X, so the light comes from there.
  EXPECT_NEAR(radianceFrom(scene.environment, {-1, 0, 0}).r, 6.0f, 0.05f);
  EXPECT_NEAR(radianceFrom(scene.environment, {0, 0, 1}).r, 3.0f, 0.05f);
  EXPECT_NEAR(radianceFrom(scene.environment, {1, 0, 0}).r, 0.0f, 0.05f);
}

TEST_F(GltfContent, AnimationsOfAllKinds) {
  GltfFile file = triangleFile();
  file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};
  const int times = file.accessor<float>({0, 1, 1, 2}, "SCALAR");
  const int moves = file.accessor<float>({0, 0, 0, 1, 0, 0, 9, 9, 9, 2, 0, 0}, "VEC3");
  const int turns =
      file.accessor<std::int8_t>({0, 0, 0, 127, 0, 127, 0, 0, 0, 0, 0, 127, 0, 127, 0, 0}, "VEC4", true);
  const int weights = file.accessor<float>({0, 1, 2, 3, 4, 5, 6, 7}, "SCALAR");
  std::vector<float> cubic(4 * 9, 0.5f);
  const int spline = file.accessor(cubic, "VEC3");
  const auto channel = [](int sampler, const char* path) {
    return Json{{"sampler", sampler}, {"target", {{"node", 0}, {"path", path}}}};
  };
  file.json["animations"][0] = {{"name", "all"},
                                {"channels",
                                 {channel(0, "translation"),
                                  channel(1, "rotation"),
                                  channel(2, "weights"),
                                  channel(3, "scale"),
                                  {{"sampler", 0}, {"target", {{"path", "pointer"}}}}}},
                                {"samplers",
                                 {{{"input", times}, {"output", moves}, {"interpolation", "LINEAR"}},
                                  {{"input", times}, {"output", turns}, {"interpolation", "STEP"}},
                                  {{"input", times}, {"output", weights}},
                                  {{"input", times}, {"output", spline}, {"interpolation", "CUBICSPLINE"}}}}};
  const Scene scene = loadScene(put("a.gltf", file.text()));
  ASSERT_EQ(scene.animations.size(), 1u);
  const auto& channels = scene.animations[0].channels;
  ASSERT_EQ(channels.size(), 4u);
  for (const AnimationChannel& c : channels)
    EXPECT_EQ(c.times_s, (std::vector<float>{0, 1, 2}));  // the repeated key is dropped
  EXPECT_EQ(channels[0].values, (std::vector<float>{0, 0, 0, 1, 0, 0, 2, 0, 0}));
  EXPECT_EQ(channels[1].interpolation, AnimationChannel::Interpolation::kStep);
  EXPECT_EQ(channels[1].values, (std::vector<float>{0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(channels[2].components, 2);
  EXPECT_EQ(channels[2].values, (std::vector<float>{0, 1, 2, 3, 6, 7}));
  EXPECT_EQ(channels[3].values.size(), 27u);
  EXPECT_TRUE(warned(scene, "1 keys are not later"));
  EXPECT_TRUE(warned(scene, "channels[4]: moves something else than a node"));
  EXPECT_EQ(scene.duration_s(), 2.0f);
}

TEST_F(GltfContent, AnimatedMatricesAreTakenApart) {
  GltfFile file = triangleFile();
  file.json["nodes"][0]["matrix"] = {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1};
  const int times = file.accessor<float>({0}, "SCALAR"), moves = file.accessor<float>({7, 8, 9}, "VEC3");
  file.json["animations"][0] = {
      {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
      {"samplers", {{{"input", times}, {"output", moves}}}}};
  const Scene scene = loadScene(put("a.gltf", file.text()));
  EXPECT_FALSE(scene.nodes[0].matrix);
  EXPECT_NEAR(scene.nodes[0].scale.x, 2.0f, 1e-5f);
  const glm::vec4 corner = pose(scene, 0.0f).instances[0].world_from_object * glm::vec4(1, 0, 0, 1);
  EXPECT_NEAR(corner.y, 10.0f, 1e-4f);
}

TEST_F(GltfContent, MeshesWithoutNodesAreShown) {
  GltfFile file = triangleFile();
  for (const char* name : {"nodes", "scenes", "scene"}) file.json.erase(name);
  const Scene scene = loadScene(put("a.gltf", file.text()));
  EXPECT_EQ(pose(scene, 0.0f).instances.size(), 1u);
  EXPECT_TRUE(warned(scene, "no node shows a mesh"));
}

TEST_F(GltfContent, RequiredExtensionsThatWeLackAreNamed) {
  GltfFile file = triangleFile();
  file.json["extensionsRequired"] = {"KHR_texture_basisu"};
  EXPECT_NE(refusal(put("a.gltf", file.text())).find("KTX2 pictures are not read"), std::string::npos);
  file.json["extensionsRequired"] = {"ACME_hologram"};
  EXPECT_NE(refusal(put("a.gltf", file.text())).find("ACME_hologram is not supported"), std::string::npos);
  file.json.erase("extensionsRequired");
  file.json["extensionsUsed"] = {"ACME_hologram", "KHR_materials_clearcoat"};
  const Scene scene = loadScene(put("a.gltf", file.text()));
  EXPECT_EQ(scene.warnings.size(), 2u);
}

TEST_F(GltfContent, ReadingReportsProgressAndCanBeInterrupted) {
  const std::string path = put("a.gltf", triangleFile().text());
  double last = -1.0;
  Progress progress;
  progress.update = [&](double fraction, const std::string&) {
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  loadScene(path, progress);
  EXPECT_EQ(last, 1.0);
  progress = {};
  progress.should_stop = [] { return true; };
  EXPECT_THROW(loadScene(path, progress), Interrupted);
}

}  // namespace
}  // namespace gloam::test
