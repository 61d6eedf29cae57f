// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Objects that move past one another: a vane that turns above what passes under it, and a ring of gold that throws caustics.
#include <cmath>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

constexpr float kPi = 3.14159265f;
constexpr float kSeconds = 8.0f;

void addTurn(SceneBuilder& builder, int node, const glm::quat& tilt, const glm::vec3& axis, float turns) {
  AnimationChannel& channel = builder.channel(node, Path::kRotation, Interpolation::kLinear);
  for (int k = 0; k <= 16; ++k) {
    const float t = float(k) / 16.0f;
    addKey(channel, kSeconds * t, tilt * glm::angleAxis(2 * kPi * turns * t, axis));
  }
}

/// To and fro along a line through `middle`, once in all.
void addSway(SceneBuilder& builder, int node, const glm::vec3& middle, const glm::vec3& reach) {
  AnimationChannel& channel = builder.channel(node, Path::kTranslation, Interpolation::kLinear);
  for (int k = 0; k <= 32; ++k) {
    const float t = float(k) / 32.0f;
    addKey(channel, kSeconds * t, middle - reach * std::cos(2 * kPi * t));
  }
}

/// Two broad blades on a hub, about the Y axis.
Mesh vane(const Detail& detail) {
  Mesh mesh = shapes::roundedBox({0.74f, 0.05f, 0.19f}, 0.045f, detail.cell(0.035f), 3);
  shapes::append(mesh, shapes::icosphere(0.14f, detail(10)));
  return mesh;
}

/// A band about the Y axis, walls upright, edges round.
Mesh band(const Detail& detail, float inner, float thickness, float height) {
  const float r = 0.5f * thickness, mid = inner + r, low = r, high = height - r;
  return shapes::revolve(
      {shapes::joined({shapes::line({inner, low}, {inner, high}, detail(10)),
                       shapes::arc({mid, high}, r, kPi, 0.0f, detail(8)),
                       shapes::line({inner + thickness, high}, {inner + thickness, low}, detail(10)),
                       shapes::arc({mid, low}, r, 0.0f, -kPi, detail(8))})},
      detail(96));
}

}  // namespace

Scene makePassing(const Detail& detail, NamedValues& values) {
  const bool has_ball = values.take("ball", 1, 0, 1) >= 0.5;
  SceneBuilder builder("passing");
  builder.place("ground", shapes::slab(2.3f, 1.7f, 0.2f, 0.05f, detail.cell(0.035f)),
                builder.diffuse("ground", {0.42f, 0.4f, 0.37f}));
  const int turning = builder.place("vane", vane(detail), builder.diffuse("red lead", {0.7f, 0.17f, 0.09f}),
                                    {0.0f, 1.08f, 0.0f});
  addTurn(builder, turning, glm::angleAxis(0.12f, glm::vec3(0, 0, 1)), {0, 1, 0}, 1.0f);
  if (has_ball) {
    const glm::vec3 middle(0.0f, 0.42f, 0.12f);
    const int ball = builder.place("ball", shapes::icosphere(0.42f, detail(24)),
                                   builder.diffuse("chalk", {0.78f, 0.77f, 0.74f}), middle);
    addSway(builder, ball, middle, {1.35f, 0, 0});
  }
  builder.camera({1.6f, 2.5f, 3.9f}, {0.1f, 0.42f, 0}, 38);
  builder.sky("preetham?elevation=48&azimuth=-80");
  return builder.finish();
}

Scene makeRing(const Detail& detail, NamedValues& values) {
  const float wave = float(values.take("wave", 0.05, 0, 0.1));
  SceneBuilder builder("ring");
  Mesh sheet = shapes::surface(detail(150), detail(110), [&](float u, float v) {
    const float x = 5.2f * (u - 0.5f), z = 3.6f * (v - 0.5f), k = 2 * kPi / 0.9f;
    const glm::vec3 normal(-wave * k * std::cos(k * x), 1.0f, 0.0f);
    return shapes::SurfacePoint{{x, wave * (std::sin(k * x) - 1.0f), z},
                                glm::normalize(normal),
                                {1.0f, wave * k * std::cos(k * x), 0.0f}};
  });
  const int waves = builder.place("sheet", std::move(sheet), builder.diffuse("paper", {0.72f, 0.71f, 0.68f}));
  addSway(builder, waves, {0, 0, 0}, {0.45f, 0, 0});
  const int ring = builder.place("ring", band(detail, 0.62f, 0.09f, 0.42f),
                                 builder.metal("gold", {0.95f, 0.68f, 0.26f}, 0.12f), {0, 0.03f, 0});
  addTurn(builder, ring, glm::angleAxis(0.0f, glm::vec3(0, 1, 0)), {0, 1, 0}, 1.0f);
  builder.camera({0.0f, 2.9f, 3.3f}, {0, 0.05f, 0.05f}, 32);
  builder.sky("preetham?elevation=32&azimuth=-50");
  return builder.finish();
}

}  // namespace gloam
