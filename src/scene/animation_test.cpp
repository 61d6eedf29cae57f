// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/animation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gloam {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

AnimationChannel channel(Path path, Interpolation interpolation, std::vector<float> times_s,
                         std::vector<float> values, int components) {
  AnimationChannel c;
  c.node = 0;
  c.path = path;
  c.interpolation = interpolation;
  c.times_s = std::move(times_s);
  c.values = std::move(values);
  c.components = components;
  return c;
}

std::vector<float> at(const AnimationChannel& c, float time_s) {
  std::vector<float> value;
  sampleChannel(c, time_s, value);
  return value;
}

TEST(Animation, StepHoldsUntilTheNextKey) {
  const AnimationChannel c = channel(Path::kTranslation, Interpolation::kStep, {1, 2}, {1, 2, 3, 4, 5, 6}, 3);
  EXPECT_EQ(at(c, 1.999f), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(at(c, 2.0f), (std::vector<float>{4, 5, 6}));
}

TEST(Animation, LinearHitsKeysAndMiddleAndIsClamped) {
  const AnimationChannel c = channel(Path::kScale, Interpolation::kLinear, {1, 3}, {0, 0, 0, 2, 4, 8}, 3);
  EXPECT_EQ(at(c, 1.0f), (std::vector<float>{0, 0, 0}));
  EXPECT_EQ(at(c, 2.0f), (std::vector<float>{1, 2, 4}));
  EXPECT_EQ(at(c, 3.0f), (std::vector<float>{2, 4, 8}));
  EXPECT_EQ(at(c, -100.0f), (std::vector<float>{0, 0, 0}));
  EXPECT_EQ(at(c, 100.0f), (std::vector<float>{2, 4, 8}));
  EXPECT_EQ(at(c, std::nanf("")), (std::vector<float>{0, 0, 0}));
}

TEST(Animation, RotationTakesTheShorterWayAtConstantSpeed) {
  const float h = std::sqrt(0.5f);
  // Identity to 90 degrees about Y; the second key is stored with the opposite sign.
  const AnimationChannel c =
      channel(Path::kRotation, Interpolation::kLinear, {0, 1}, {0, 0, 0, 1, 0, -h, 0, -h}, 4);
  for (const float u : {0.25f, 0.5f, 0.75f}) {
    const std::vector<float> q = at(c, u);
    const float half_angle = u * glm::radians(45.0f);
    const float sign = q[3] < 0 ? -1.0f : 1.0f;
    EXPECT_NEAR(sign * q[1], std::sin(half_angle), 1e-6f);
    EXPECT_NEAR(sign * q[3], std::cos(half_angle), 1e-6f);
    EXPECT_NEAR(q[0], 0.0f, 1e-6f);
    EXPECT_NEAR(q[2], 0.0f, 1e-6f);
  }
}

TEST(Animation, CubicSplineHitsKeysAndTangents) {
  // Keys 1 and 5 over two seconds, slopes 3 and -2: layout is in-tangent, value, out-tangent.
  const AnimationChannel c =
      channel(Path::kWeights, Interpolation::kCubicSpline, {0, 2}, {99, 1, 3, -2, 5, 99}, 1);
  EXPECT_FLOAT_EQ(at(c, 0.0f)[0], 1.0f);
  EXPECT_FLOAT_EQ(at(c, 2.0f)[0], 5.0f);
  const float h = 1e-2f;
  EXPECT_NEAR((at(c, h)[0] - at(c, 0.0f)[0]) / h, 3.0f, 0.05f);
  EXPECT_NEAR((at(c, 2.0f)[0] - at(c, 2.0f - h)[0]) / h, -2.0f, 0.05f);
  // The middle of a Hermite curve: (p0 + p1) / 2 + d (m0 - m1) / 8.
  EXPECT_FLOAT_EQ(at(c, 1.0f)[0], 3.0f + 2.0f * (3.0f + 2.0f) / 8.0f);
}

TEST(Animation, CubicSplineRotationStaysUnit) {
  const AnimationChannel c =
      channel(Path::kRotation, Interpolation::kCubicSpline, {0, 1},
              {0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, 4);
  for (float t = 0.0f; t <= 1.0f; t += 0.1f) {
    const std::vector<float> q = at(c, t);
    EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0f, 1e-5f);
  }
}

TEST(Animation, TheFirstAnimationOfAPropertyPlays) {
  Scene scene;
  scene.nodes.resize(2);
  AnimationChannel walk = channel(Path::kTranslation, Interpolation::kLinear, {0, 1}, {0, 0, 0, 1, 0, 0}, 3);
  AnimationChannel run = channel(Path::kTranslation, Interpolation::kLinear, {0, 9}, {0, 0, 0, 9, 0, 0}, 3);
  AnimationChannel other = run;
  other.node = 1;
  other.times_s = {0, 4};
  scene.animations = {{"walk", {walk}}, {"run", {run, other}}};
  const auto playing = channelsInPlay(scene);
  ASSERT_EQ(playing.size(), 2u);
  EXPECT_EQ(playing[0], &scene.animations[0].channels[0]);
  EXPECT_EQ(playing[1], &scene.animations[1].channels[1]);
  EXPECT_EQ(scene.duration_s(), 4.0f);
  EXPECT_EQ(Scene{}.duration_s(), 0.0f);
}

TEST(Animation, MeshesMoveApartWhereTheyHangOnDifferentMovingNodes) {
  Scene scene;
  scene.meshes.resize(1);
  scene.meshes[0].indices = {0, 1, 2};
  scene.nodes.resize(4);  // 0 carries 1; 2 stands alone; 3 shows nothing
  scene.nodes[0].children = {1};
  scene.roots = {0, 2, 3};
  for (const std::size_t i : {0, 1, 2}) scene.nodes[i].meshes = {0};
  const auto animate = [&](int node, std::vector<float> values, Path path = Path::kTranslation) {
    AnimationChannel moving = channel(path, Interpolation::kLinear, {0, 1}, std::move(values), 3);
    moving.node = node;
    scene.animations = {{"", {moving}}};
  };
  EXPECT_FALSE(movesApart(scene));
  animate(0, {0, 0, 0, 1, 0, 0});
  EXPECT_TRUE(movesApart(scene));
  animate(0, {1, 0, 0, 1, 0, 0});  // stands still
  EXPECT_FALSE(movesApart(scene));
  animate(3, {0, 0, 0, 1, 0, 0});
  EXPECT_FALSE(movesApart(scene));
  animate(0, {0, 0, 0, 1, 0, 0});
  scene.nodes[2].meshes.clear();  // what is left moves as one
  EXPECT_FALSE(movesApart(scene));
  animate(1, {0, 0, 0, 1, 0, 0});
  EXPECT_TRUE(movesApart(scene));
  scene.nodes[1].skin = 0;  // is not baked
  EXPECT_FALSE(movesApart(scene));
}

}  // namespace
}  // namespace gloam
