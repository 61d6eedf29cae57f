// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/builtin_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/figure.h"
#include "scene/mesh_laws.h"

namespace gloam {
namespace {

std::string messageOf(const std::string& description) {
  try {
    makeBuiltinScene(description);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

const Mesh& meshNamed(const Scene& scene, const std::string& name) {
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.name == name) return mesh;
  }
  throw std::runtime_error("no mesh " + name);
}

class BuiltinScenes : public testing::TestWithParam<BuiltinScene> {};

TEST_P(BuiltinScenes, HaveLawfulMeshesAMaterialEachAndACamera) {
  const Scene scene = makeBuiltinScene(GetParam().name);
  EXPECT_EQ(scene.name, GetParam().name);
  EXPECT_FALSE(scene.meshes.empty());
  for (const Mesh& mesh : scene.meshes) {
    SCOPED_TRACE(mesh.name);
    EXPECT_LT(mesh_laws::frameError(mesh), 1e-4f);
    EXPECT_GT(mesh_laws::leastNormalAgreement(mesh), 0.3f);
    ASSERT_GE(mesh.uv_sets.size(), 1u);
    for (const auto& uv_set : mesh.uv_sets) EXPECT_EQ(uv_set.size(), mesh.vertexCount());
    EXPECT_TRUE(mesh.material >= 0 && mesh.material < int(scene.materials.size()));
    for (const std::uint32_t i : mesh.indices) ASSERT_LT(i, mesh.vertexCount());
  }
  for (const Material& material : scene.materials) {
    for (const TextureSlot* slot :
         {&material.base_color_map, &material.metallic_roughness_map, &material.normal_map}) {
      EXPECT_LT(slot->texture, int(scene.textures.size()));
    }
  }
  const PosedScene posed = pose(scene, 0.3f);
  ASSERT_EQ(posed.cameras.size(), 1u);
  EXPECT_FALSE(posed.instances.empty());
  const bool glows = std::ranges::any_of(
      scene.materials, [](const Material& material) { return material.emission != glm::vec3(0.0f); });
  EXPECT_TRUE(glows || !posed.lights.empty() || !scene.environment.radiance.empty());
  // The camera stands outside and looks at the scene.
  const glm::vec3 middle = 0.5f * (posed.bounds_min + posed.bounds_max);
  const glm::vec3 seen = glm::vec3(glm::inverse(posed.cameras[0].world_from_view) * glm::vec4(middle, 1.0f));
  EXPECT_LT(seen.z, 0.0f);
  EXPECT_LT(std::abs(seen.x), -0.5f * seen.z);
}

TEST_P(BuiltinScenes, DetailMultipliesVertices) {
  const auto vertices = [](const Scene& scene) {
    std::size_t sum = 0;
    for (const Mesh& mesh : scene.meshes) sum += mesh.vertexCount();
    return sum;
  };
  const std::string name = GetParam().name;
  EXPECT_GT(vertices(makeBuiltinScene(name + "?detail=1")),
            2 * vertices(makeBuiltinScene(name + "?detail=0.5")));
}

INSTANTIATE_TEST_SUITE_P(All, BuiltinScenes, testing::ValuesIn(builtinScenes()),
                         [](const testing::TestParamInfo<BuiltinScene>& info) {
                           std::string name = info.param.name;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

TEST(BuiltinScene, UnknownNamesAndKeysAreToldWhatThereIs) {
  EXPECT_NE(messageOf("temple").find("there are furnace, furnace-concave"), std::string::npos);
  EXPECT_NE(messageOf("cornell?size=3").find("unknown key 'size'; there are detail"), std::string::npos);
  EXPECT_NE(messageOf("bowl?coverage=2").find("coverage: 2 is outside 0.05 to 0.95"), std::string::npos);
}

TEST(BuiltinScene, FurnacesAreClosedWhiteAndPurelyDiffuse) {
  for (const char* name : {"furnace", "furnace-concave"}) {
    const Scene scene = makeBuiltinScene(name);
    EXPECT_EQ(mesh_laws::openEdges(scene.meshes[0]), 0);
    EXPECT_GT(mesh_laws::signedVolume(scene.meshes[0]), 0.0);
    const Material& material = scene.materials.at(0);
    EXPECT_EQ(glm::vec3(material.base_color), glm::vec3(1.0f));
    EXPECT_EQ(material.metallic, 0.0f);
    EXPECT_EQ(material.specular, 0.0f);
    EXPECT_EQ(radianceFrom(scene.environment, {0.6f, -0.8f, 0.0f}), glm::vec3(1.0f));
  }
}

TEST(BuiltinScene, BowlCoversTheShareAskedFor) {
  const Scene scene = makeBuiltinScene("bowl?coverage=0.3&albedo=0.8");
  float highest = -1.0f;
  for (const glm::vec3& p : scene.meshes[0].positions) highest = std::max(highest, p.y);
  EXPECT_NEAR(highest, 2.0f * 0.3f - 1.0f, 1e-5f);  // a cap's share of the area is its share of the height
  EXPECT_FLOAT_EQ(scene.materials[0].base_color.y, 0.8f);
}

TEST(Figure, BodyIsOneClosedMeshWithWholeWeights) {
  const Mesh mesh = figure::body(0.019f);
  EXPECT_EQ(mesh_laws::openEdges(mesh), 0);
  EXPECT_NEAR(mesh_laws::signedVolume(mesh), 0.055, 0.02);  // a slender adult of water: 55 kg
  ASSERT_EQ(mesh.weights.size(), mesh.vertexCount() * 4);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    float sum = 0.0f;
    for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) {
      sum += mesh.weights[k];
      ASSERT_LT(mesh.joints[k], std::uint16_t(figure::kJoints));
    }
    EXPECT_NEAR(sum, 1.0f, 1e-5f);
  }
}

// World position of a joint by walking up the skeleton.
glm::vec3 jointInWorld(const figure::Posture& posture, std::size_t joint) {
  glm::vec3 p(0.0f);
  for (int j = int(joint); j != kNone;) {
    const figure::JointInfo& info = figure::joints()[std::size_t(j)];
    const glm::vec3 offset = info.parent == kNone
                                 ? posture.pelvis
                                 : info.position - figure::joints()[std::size_t(info.parent)].position;
    p = offset + posture.rotation[std::size_t(j)] * p;
    if (info.parent == kNone) break;
    // Rotate by the parent on the next turn: p is relative to the parent's origin now.
    j = info.parent;
  }
  return p;
}

TEST(Figure, WalkRepeatsAndStandingFeetDoNotSlide) {
  const figure::Walk walk;
  const figure::Posture first = figure::walking(walk, 0.0f), last = figure::walking(walk, walk.seconds);
  EXPECT_LT(glm::length(first.pelvis - last.pelvis), 1e-4f);
  for (std::size_t j = 0; j < figure::kJoints; ++j) {
    EXPECT_GT(std::abs(glm::dot(first.rotation[j], last.rotation[j])), 0.9999f);
  }
  // The left foot stands flat from shortly before to after the body passes over it at time 0.
  const float step_s = walk.seconds / float(walk.steps);
  const glm::vec3 print = jointInWorld(figure::walking(walk, 0.0f), figure::kFootLeft);
  for (const float t : {-0.4f, -0.2f, 0.05f}) {
    const glm::vec3 ankle = jointInWorld(figure::walking(walk, t * step_s), figure::kFootLeft);
    EXPECT_LT(glm::length(ankle - print), 2e-3f) << t;
  }
}

TEST(Figure, SkinnedFeetStayOnTheGround) {
  const Scene scene = makeBuiltinScene("walker?detail=0.5");
  EXPECT_FLOAT_EQ(scene.duration_s(), 8.0f);
  for (const float t : {0.0f, 0.2f, 0.41f, 0.6f, 3.3f, 7.9f}) {
    for (const Instance& instance : pose(scene, t).instances) {
      if (scene.meshes[std::size_t(instance.mesh)].name != "figure") continue;
      float lowest = 1.0f, highest = 0.0f;
      for (const glm::vec3& p : instance.deformed_positions) {
        lowest = std::min(lowest, p.y);
        highest = std::max(highest, p.y);
      }
      EXPECT_NEAR(lowest, 0.0f, 0.02f) << t;
      EXPECT_NEAR(highest, 1.68f, 0.06f) << t;
    }
  }
  EXPECT_EQ(mesh_laws::openEdges(meshNamed(scene, "figure")), 0);
}

}  // namespace
}  // namespace gloam
