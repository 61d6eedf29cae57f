// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/scene.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "scene/transforms.h"

namespace gloam {
namespace {

constexpr float kHalfPi = 1.57079633f;

void expectNear(const glm::vec3& a, const glm::vec3& b, float tolerance) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

// A quad in the XY plane that faces +Z, from (0, 0) to (1, 1).
Mesh quad() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.tangents.assign(4, {1, 0, 0, 1});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

int addNode(Scene& scene, int parent) {
  scene.nodes.emplace_back();
  const int index = int(scene.nodes.size()) - 1;
  scene.nodes.back().parent = parent;
  if (parent == kNone) {
    scene.roots.push_back(index);
  } else {
    scene.nodes[std::size_t(parent)].children.push_back(index);
  }
  return index;
}

Scene quadScene() {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes = {quad()};
  scene.nodes[std::size_t(addNode(scene, kNone))].meshes = {0};
  return scene;
}

glm::mat3 randomMatrix(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  glm::mat3 m;
  for (int c = 0; c < 3; ++c) m[c] = {uniform(random), uniform(random), uniform(random)};
  return m;
}

TEST(Transforms, RotationFactorIsOrthogonalAndLeavesASymmetricPositiveRest) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const glm::mat3 m = randomMatrix(random);
    if (std::abs(glm::determinant(m)) < 1e-3f) continue;
    const glm::mat3 q = rotationFactor(m);
    const glm::mat3 identity = glm::transpose(q) * q;
    const glm::mat3 rest = glm::transpose(q) * m;
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) {
        EXPECT_NEAR(identity[c][r], c == r ? 1.0f : 0.0f, 1e-5f);
        EXPECT_NEAR(rest[c][r], rest[r][c], 1e-5f);
      }
    }
    EXPECT_GT(rest[0][0] + rest[1][1] + rest[2][2], 0.0f);
    EXPECT_GT(glm::determinant(rest), 0.0f);  // a reflection belongs to q
  }
}

TEST(Transforms, RotationFactorOfAFlattenedMatrixIsStillARotation) {
  const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), 0.7f, glm::normalize(glm::vec3(1, 2, 3))));
  for (int axis = 0; axis < 3; ++axis) {
    glm::mat3 flat = turn;
    flat[axis] = glm::vec3(0.0f);
    const glm::mat3 q = rotationFactor(flat);
    for (int c = 0; c < 3; ++c) expectNear(q[c], turn[c], 1e-5f);
    glm::mat3 line(0.0f);
    line[axis] = turn[axis];
    EXPECT_NEAR(glm::determinant(rotationFactor(line)), 1.0f, 1e-5f);
  }
  EXPECT_EQ(rotationFactor(glm::mat3(0.0f)), glm::mat3(1.0f));
}

TEST(Transforms, DecompositionIsUndoneByComposition) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  for (int i = 0; i < 100; ++i) {
    Trs trs;
    trs.translation = {uniform(random), uniform(random), uniform(random)};
    trs.rotation =
        glm::normalize(glm::quat(uniform(random), uniform(random), uniform(random), uniform(random)));
    trs.scale = {uniform(random), uniform(random), uniform(random)};
    if (std::min({std::abs(trs.scale.x), std::abs(trs.scale.y), std::abs(trs.scale.z)}) < 1e-2f) continue;
    const glm::mat4 m = composeTrs(trs);
    const std::optional<Trs> again = decomposeTrs(m);
    ASSERT_TRUE(again);
    const glm::mat4 m2 = composeTrs(*again);
    for (int c = 0; c < 4; ++c) EXPECT_LT(glm::length(m[c] - m2[c]), 1e-5f);
  }
  glm::mat4 shear(1.0f);
  shear[1].x = 0.3f;
  EXPECT_FALSE(decomposeTrs(shear));
  EXPECT_FALSE(decomposeTrs(glm::scale(glm::mat4(1.0f), {1.0f, 0.0f, 1.0f})));
}

TEST(Transforms, AnyLinearMapIsTwoRotationsAndAScale) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    glm::mat3 m = randomMatrix(random);
    if (i % 4 == 0) m[1] = 0.5f * m[0];      // flattened to a plane
    if (i % 8 == 0) m[2] = glm::vec3(0.0f);  // or to a line
    if (i == 1) m = glm::mat3(1.0f);
    const RotatedScale parts = decomposeLinear(m);
    glm::mat3 scale(0.0f);
    for (int c = 0; c < 3; ++c) scale[c][c] = parts.scale[c];
    const glm::mat3 again = glm::mat3_cast(parts.outer) * scale * glm::mat3_cast(parts.inner);
    for (int c = 0; c < 3; ++c) expectNear(again[c], m[c], 1e-5f);
  }
}

TEST(Pose, IdentityLeavesVerticesAndBounds) {
  const PosedScene posed = pose(quadScene(), 0.0f);
  ASSERT_EQ(posed.instances.size(), 1u);
  EXPECT_FALSE(posed.instances[0].deformed());
  EXPECT_EQ(posed.instances[0].world_from_object, glm::mat4(1.0f));
  EXPECT_EQ(posed.bounds_min, glm::vec3(0.0f));
  EXPECT_EQ(posed.bounds_max, glm::vec3(1.0f, 1.0f, 0.0f));
}

TEST(Pose, EmptySceneHasNoInstancesAndFiniteBounds) {
  const PosedScene posed = pose(Scene{}, 0.0f);
  EXPECT_TRUE(posed.instances.empty());
  EXPECT_EQ(posed.bounds_min, glm::vec3(0.0f));
  const PosedCamera camera = framingCamera(posed, 1.0f);
  EXPECT_TRUE(std::isfinite(camera.world_from_view[3].z));
}

TEST(Pose, ParentsApplyBeforeChildrenWhateverTheOrderOfNodes) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes = {quad()};
  scene.nodes.resize(3);
  scene.nodes[0].parent = 2;  // the leaf comes first
  scene.nodes[0].meshes = {0};
  scene.nodes[0].translation = {1, 0, 0};
  scene.nodes[2].parent = 1;
  scene.nodes[2].children = {0};
  scene.nodes[2].rotation = glm::angleAxis(kHalfPi, glm::vec3(0, 1, 0));
  scene.nodes[1].children = {2};
  scene.nodes[1].matrix = glm::translate(glm::mat4(1.0f), {0, 5, 0});
  scene.roots = {1};
  const PosedScene posed = pose(scene, 0.0f);
  ASSERT_EQ(posed.instances.size(), 1u);
  expectNear(glm::vec3(posed.instances[0].world_from_object[3]), {0, 5, -1}, 1e-5f);
}

TEST(Pose, NodesOutsideTheShownSceneAreNotDrawn) {
  Scene scene = quadScene();
  scene.nodes[std::size_t(addNode(scene, kNone))].meshes = {0};
  scene.roots = {1};
  const PosedScene posed = pose(scene, 0.0f);
  ASSERT_EQ(posed.instances.size(), 1u);
  EXPECT_EQ(posed.instances[0].node, 1);
}

TEST(Pose, InstancesStandWhereTheyAreSaidTo) {
  Scene scene = quadScene();
  scene.nodes[0].translation = {10, 0, 0};
  scene.nodes[0].instances = {glm::translate(glm::mat4(1.0f), {0, 1, 0}),
                              glm::translate(glm::mat4(1.0f), {0, 2, 0})};
  const PosedScene posed = pose(scene, 0.0f);
  ASSERT_EQ(posed.instances.size(), 2u);
  expectNear(glm::vec3(posed.instances[1].world_from_object[3]), {10, 2, 0}, 1e-6f);
  expectNear(posed.bounds_max, {11, 3, 0}, 1e-6f);
}

TEST(Pose, MorphTargetsAddByWeightAndAnimate) {
  Scene scene = quadScene();
  MorphTarget target;
  target.positions.assign(4, {0, 0, 2});
  target.normals.assign(4, {1, 0, -1});
  scene.meshes[0].morph_targets = {target};
  scene.nodes[0].morph_weights = {0.0f};
  EXPECT_FALSE(pose(scene, 0.0f).instances[0].deformed());  // nothing to deform
  AnimationChannel channel;
  channel.node = 0;
  channel.path = AnimationChannel::Path::kWeights;
  channel.components = 1;
  channel.times_s = {0, 1};
  channel.values = {0, 1};
  scene.animations = {{"swell", {channel}}};
  scene.nodes[0].translation = {0, 0, 1};
  const Instance half = pose(scene, 0.5f).instances[0];
  ASSERT_TRUE(half.deformed());
  EXPECT_EQ(half.world_from_object, glm::mat4(1.0f));
  expectNear(half.deformed_positions[2], {1, 1, 2}, 1e-6f);
  expectNear(half.deformed_normals[2], glm::normalize(glm::vec3(0.5f, 0, 0.5f)), 1e-6f);
  expectNear(pose(scene, 7.0f).instances[0].deformed_positions[2], {1, 1, 3}, 1e-6f);
}

// A beam of unit length along +Y from y = 0 to 2, a joint at 0 and one at 1; vertices above 1 follow the
// second joint.
Scene beamScene(int influences) {
  Scene scene;
  scene.materials.resize(1);
  Mesh mesh;
  for (int i = 0; i <= 4; ++i) {
    for (const float x : {-0.1f, 0.1f}) {
      mesh.positions.push_back({x, 0.5f * float(i), 0.0f});
      mesh.normals.push_back({x < 0 ? -1.0f : 1.0f, 0, 0});
      mesh.tangents.push_back({0, 0, 1, 1});
    }
  }
  for (unsigned i = 0; i < 4; ++i) {
    const unsigned a = 2 * i;
    mesh.indices.insert(mesh.indices.end(), {a, a + 1, a + 3, a, a + 3, a + 2});
  }
  mesh.influences = influences;
  mesh.joints.assign(mesh.vertexCount() * std::size_t(influences), 0);
  mesh.weights.assign(mesh.vertexCount() * std::size_t(influences), 0.0f);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const std::size_t last = v * std::size_t(influences) + std::size_t(influences) - 1;
    mesh.joints[last] = mesh.positions[v].y > 1.0f ? 1 : 0;
    mesh.weights[last] = 1.0f;
  }
  scene.meshes = {mesh};
  const int body = addNode(scene, kNone);
  const int lower = addNode(scene, kNone);
  const int upper = addNode(scene, lower);
  scene.nodes[std::size_t(body)].meshes = {0};
  scene.nodes[std::size_t(body)].skin = 0;
  scene.nodes[std::size_t(body)].translation = {100, 100, 100};  // must not matter
  scene.nodes[std::size_t(upper)].translation = {0, 1, 0};
  Skin skin;
  skin.joints = {lower, upper};
  skin.joint_from_mesh = {glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), {0, -1, 0})};
  scene.skins = {skin};
  return scene;
}

TEST(Pose, SkinAtRestGivesTheMeshBack) {
  const Scene scene = beamScene(4);
  const Instance instance = pose(scene, 0.0f).instances[0];
  ASSERT_TRUE(instance.deformed());
  for (std::size_t v = 0; v < scene.meshes[0].vertexCount(); ++v) {
    expectNear(instance.deformed_positions[v], scene.meshes[0].positions[v], 1e-6f);
    expectNear(instance.deformed_normals[v], scene.meshes[0].normals[v], 1e-6f);
  }
}

TEST(Pose, TwoBoneSkinBendsByARightAngle) {
  for (const int influences : {1, 4, 8, 11}) {
    Scene scene = beamScene(influences);
    scene.nodes[2].rotation = glm::angleAxis(kHalfPi, glm::vec3(0, 0, 1));  // +Y turns to -X
    const Instance instance = pose(scene, 0.0f).instances[0];
    expectNear(instance.deformed_positions[8], {-1, 1 - 0.1f, 0}, 1e-5f);  // was (-0.1, 2, 0)
    expectNear(instance.deformed_normals[8], {0, -1, 0}, 1e-5f);
    expectNear(instance.deformed_positions[0], {-0.1f, 0, 0}, 1e-5f);
    expectNear(instance.deformed_normals[0], {-1, 0, 0}, 1e-5f);
  }
}

TEST(Pose, SkinNormalsFollowTheInverseTranspose) {
  Scene scene = beamScene(4);
  scene.nodes[1].scale = {1.0f, 3.0f, 1.0f};
  for (glm::vec3& n : scene.meshes[0].normals) n = glm::normalize(glm::vec3(1, 1, 0));
  const Instance instance = pose(scene, 0.0f).instances[0];
  expectNear(instance.deformed_normals[0], glm::normalize(glm::vec3(1, 1.0f / 3.0f, 0)), 1e-5f);
  // Tangents stay in the surface.
  for (std::size_t v = 0; v < instance.deformed_tangents.size(); ++v) {
    EXPECT_NEAR(glm::dot(glm::vec3(instance.deformed_tangents[v]), instance.deformed_normals[v]), 0.0f,
                1e-5f);
  }
}

TEST(Pose, CollapsedJointGivesFiniteVertices) {
  Scene scene = beamScene(4);
  scene.nodes[1].scale = glm::vec3(0.0f);
  const Instance instance = pose(scene, 0.0f).instances[0];
  for (const glm::vec3& n : instance.deformed_normals) EXPECT_NEAR(glm::length(n), 1.0f, 1e-5f);
}

TEST(Pose, CamerasAndLightsStandInTheWorldWithoutScale) {
  Scene scene;
  const int node = addNode(scene, kNone);
  scene.nodes[0].translation = {1, 2, 3};
  scene.nodes[0].rotation = glm::angleAxis(kHalfPi, glm::vec3(0, 1, 0));
  scene.nodes[0].scale = {2, 5, 1};
  scene.nodes[std::size_t(node)].camera = 0;
  scene.nodes[std::size_t(node)].light = 0;
  scene.cameras.resize(1);
  scene.lights.resize(1);
  const PosedScene posed = pose(scene, 0.0f);
  ASSERT_EQ(posed.cameras.size(), 1u);
  ASSERT_EQ(posed.lights.size(), 1u);
  expectNear(posed.lights[0].position, {1, 2, 3}, 1e-6f);
  expectNear(posed.lights[0].direction, {-1, 0, 0}, 1e-6f);
  EXPECT_NEAR(glm::determinant(posed.cameras[0].world_from_view), 1.0f, 1e-5f);
  expectNear(-glm::vec3(posed.cameras[0].world_from_view[2]), {-1, 0, 0}, 1e-6f);
}

TEST(Pose, FramingCameraSeesEveryCornerAndFillsThePicture) {
  for (const float aspect : {0.4f, 1.0f, 2.5f}) {
    Scene scene = quadScene();
    scene.nodes[0].scale = {7, 2, 1};
    const PosedScene posed = pose(scene, 0.0f);
    const PosedCamera camera = framingCamera(posed, aspect);
    const glm::mat4 clip_from_world =
        glm::perspective(camera.camera.vertical_fov_rad, aspect, camera.camera.z_near, 1000.0f) *
        glm::inverse(camera.world_from_view);
    float extent = 0.0f;
    for (const glm::vec3& p : scene.meshes[0].positions) {
      const glm::vec4 clip = clip_from_world * posed.instances[0].world_from_object * glm::vec4(p, 1.0f);
      EXPECT_GT(clip.w, camera.camera.z_near);
      extent = std::max({extent, std::abs(clip.x / clip.w), std::abs(clip.y / clip.w)});
    }
    EXPECT_LT(extent, 1.0f);
    EXPECT_GT(extent, 0.85f);
  }
}

TEST(Pose, OrbitKeepsDistanceAndHeightAndReturnsAfterAFullTurn) {
  const PosedScene posed = pose(quadScene(), 0.0f);
  const PosedCamera camera = framingCamera(posed, 1.0f);
  const glm::vec3 centre(0.5f, 0.5f, 0.0f), eye(camera.world_from_view[3]);
  const PosedCamera quarter = orbit(camera, posed, kHalfPi);
  const glm::vec3 turned(quarter.world_from_view[3]);
  EXPECT_NEAR(glm::length(turned - centre), glm::length(eye - centre), 1e-4f);
  EXPECT_NEAR(turned.y, eye.y, 1e-5f);
  EXPECT_NEAR(turned.x - centre.x, eye.z - centre.z, 1e-4f);  // +Z turns to +X: counter-clockwise from above
  expectNear(glm::vec3(orbit(camera, posed, 4 * kHalfPi).world_from_view[3]), eye, 1e-4f);
}

}  // namespace
}  // namespace gloam
