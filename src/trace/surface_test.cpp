// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "trace/surface.h"

#include <gtest/gtest.h>

#include <limits>

namespace gloam::trace {
namespace {

// Two by two texels: black, red / green, grey 188 (linear 0.5029), all opaque.
Scene sceneWithTexture() {
  Scene scene;
  scene.textures.push_back({"", 2, 2, {0, 0, 0, 255, 255, 0, 0, 255, 0, 255, 0, 255, 188, 188, 188, 255}});
  scene.materials.emplace_back();
  scene.materials[0].metallic = 0.0f;
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.indices = {0, 1, 2};
  mesh.uv_sets = {{{0.25f, 0.25f}, {0.75f, 0.25f}, {0.25f, 0.75f}}};
  scene.meshes.push_back(mesh);
  return scene;
}

void expectNear(const glm::vec3& a, const glm::vec3& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-4f);
}

TEST(Surface, TexelCentresAndBilinearBetween) {
  const Scene scene = sceneWithTexture();
  TextureSlot slot;
  slot.texture = 0;
  expectNear(sampleTexture(scene, slot, {0.25f, 0.25f}, true), {0, 0, 0});
  expectNear(sampleTexture(scene, slot, {0.75f, 0.25f}, true), {1, 0, 0});
  expectNear(sampleTexture(scene, slot, {0.25f, 0.75f}, true), {0, 1, 0});
  expectNear(sampleTexture(scene, slot, {0.75f, 0.75f}, true), glm::vec3(0.5029f));
  // sRGB is decoded before mixing: half of red is 0.5, not 0.214.
  expectNear(sampleTexture(scene, slot, {0.5f, 0.25f}, true), {0.5f, 0, 0});
  expectNear(sampleTexture(scene, slot, {0.75f, 0.75f}, false), glm::vec3(188.0f / 255.0f));
  slot.nearest = true;
  expectNear(sampleTexture(scene, slot, {0.49f, 0.49f}, true), {0, 0, 0});
  expectNear(sampleTexture(scene, slot, {0.51f, 0.49f}, true), {1, 0, 0});
}

TEST(Surface, WrapsAndTransforms) {
  const Scene scene = sceneWithTexture();
  TextureSlot slot;
  slot.texture = 0;
  const auto at = [&](float u, float v) { return glm::vec3(sampleTexture(scene, slot, {u, v}, true)); };
  expectNear(at(-3.25f, 4.25f), {1, 0, 0});
  expectNear(at(0.0f, 0.25f), {0.5f, 0, 0});  // half of each side of the seam
  slot.wrap_u = Wrap::kClampToEdge;
  expectNear(at(0.0f, 0.25f), {0, 0, 0});
  expectNear(at(1e30f, 0.25f), {1, 0, 0});
  slot.wrap_u = Wrap::kMirroredRepeat;
  expectNear(at(1.25f, 0.25f), {1, 0, 0});
  expectNear(at(-0.25f, 0.25f), {0, 0, 0});
  slot.texture_from_uv[2] = {0.5f, 0.0f, 1.0f};  // moves u by half
  expectNear(at(0.25f, 0.25f), {1, 0, 0});
  slot.wrap_u = Wrap::kRepeat;
  expectNear(at(std::numeric_limits<float>::quiet_NaN(), 0.25f),
             at(-0.5f, 0.0f));  // as if it were moved to (0, 0)
}

TEST(Surface, AlbedoIsMapTimesFactorTimesVertexColorLessMetal) {
  Scene scene = sceneWithTexture();
  Mesh& mesh = scene.meshes[0];
  Material& material = scene.materials[0];
  material.base_color = {0.5f, 1.0f, 1.0f, 0.25f};
  expectNear(diffuseAlbedo(scene, mesh, {0, 0.3f, 0.3f}), {0.5f, 1.0f, 1.0f});
  mesh.colors = {{1, 1, 1, 1}, {0, 0, 1, 1}, {1, 1, 1, 0}};
  expectNear(diffuseAlbedo(scene, mesh, {0, 1.0f, 0.0f}), {0.0f, 0.0f, 1.0f});
  expectNear(diffuseAlbedo(scene, mesh, {0, 0.5f, 0.0f}), {0.25f, 0.5f, 1.0f});
  EXPECT_NEAR(baseColor(scene, mesh, {0, 0.0f, 0.5f}).a, 0.125f, 1e-6f);
  mesh.colors.clear();
  material.base_color_map.texture = 0;
  expectNear(diffuseAlbedo(scene, mesh, {0, 1.0f, 0.0f}), {0.5f, 0.0f, 0.0f});
  expectNear(diffuseAlbedo(scene, mesh, {0, 0.5f, 0.0f}), {0.25f, 0.0f, 0.0f});
  material.base_color_map.uv_set = 3;  // not there: (0, 0), where four texels meet
  expectNear(diffuseAlbedo(scene, mesh, {0, 1.0f, 0.0f}), {0.5f * 0.37573f, 0.37573f, 0.12573f});
  material.base_color_map = {};
  material.metallic = 1.0f;
  material.metallic_roughness_map.texture = 0;  // B of the fourth texel is 188 / 255
  mesh.uv_sets[0][1] = {0.75f, 0.75f};
  expectNear(diffuseAlbedo(scene, mesh, {0, 1.0f, 0.0f}), glm::vec3(0.5f, 1, 1) * (67.0f / 255.0f));
  EXPECT_NEAR(metallicRoughness(scene, mesh, {0, 1.0f, 0.0f}).y, 188.0f / 255.0f, 1e-6f);
}

}  // namespace
}  // namespace gloam::trace
