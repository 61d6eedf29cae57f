// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light that is near: things that move among glowing panels and a lamp.
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kSeconds = 8.0f;
using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

int glowing(SceneBuilder& builder, const std::string& name, const glm::vec3& radiance) {
  const int material = builder.diffuse(name, glm::vec3(0.0f));
  builder.material(material).emission = radiance;
  return material;
}

/// A panel with a back, that faces `toward`.
void addPanel(SceneBuilder& builder, const std::string& name, const glm::vec3& radiance,
              const glm::vec3& middle, float turn_deg, const Detail& detail) {
  const int node = builder.node(name, kNone, middle);
  builder.at(node).rotation = glm::angleAxis(glm::radians(turn_deg), glm::vec3(0, 1, 0));
  const float half_x = 0.5f, half_y = 0.62f;
  builder.place(name + " glow",
                shapes::patch({-half_x, half_y, 0.04f}, {2 * half_x, 0, 0}, {0, -2 * half_y, 0},
                              shapes::steps(4), shapes::steps(4)),
                glowing(builder, name, radiance), glm::vec3(0.0f), node);
  builder.place(
      name + " frame",
      shapes::moved(shapes::roundedBox({half_x + 0.03f, half_y + 0.03f, 0.03f}, 0.012f, detail.cell(0.12f)),
                    {0, 0, 0}),
      builder.diffuse(name + " frame", glm::vec3(0.1f)), glm::vec3(0.0f), node);
}

void addTurn(SceneBuilder& builder, int node, const glm::vec3& axis, float turns) {
  AnimationChannel& channel = builder.channel(node, Path::kRotation, Interpolation::kLinear);
  for (int k = 0; k <= 16; ++k)
    addKey(channel, kSeconds * float(k) / 16.0f, glm::angleAxis(2 * kPi * turns * float(k) / 16.0f, axis));
}

/// An ellipse about a middle, once round.
void addRound(SceneBuilder& builder, int node, const glm::vec3& middle, const glm::vec2& radii, float phase) {
  AnimationChannel& channel = builder.channel(node, Path::kTranslation, Interpolation::kLinear);
  for (int k = 0; k <= 48; ++k) {
    const float angle = phase + 2 * kPi * float(k) / 48.0f;
    addKey(channel, kSeconds * float(k) / 48.0f,
           middle + glm::vec3(radii.x * std::cos(angle), 0.0f, radii.y * std::sin(angle)));
  }
}

}  // namespace

/// The knot, and of what lights it a panel or a lamp alone, out of the picture.
static Scene makeLantern(SceneBuilder& builder, const Detail& detail, bool lamp_alone) {
  builder.place("knot", shapes::torusKnot(2, 3, 0.34f, 0.15f, 0.085f, detail(220), detail(18)),
                builder.diffuse("chalk", {0.78f, 0.77f, 0.75f}));
  if (lamp_alone) {
    Light lamp;
    lamp.name = "lamp";
    lamp.intensity = {2.6f, 2.4f, 2.2f};
    builder.light(lamp, {-0.6f, 1.2f, 0.6f});
  } else {
    addPanel(builder, "amber", {6.0f, 2.6f, 0.6f}, {-0.95f, 0.0f, 0.1f}, 90.0f, detail);
  }
  builder.camera({0.4f, 0.5f, 2.2f}, {0.0f, 0.0f, 0.0f}, 30);
  return builder.finish();
}

Scene makeLanterns(const Detail& detail, NamedValues& values) {
  SceneBuilder builder("lanterns");
  const int alone = int(values.take("alone", 0, 0, 2));
  if (alone > 0) return makeLantern(builder, detail, alone == 2);
  builder.place("floor", shapes::slab(2.3f, 1.9f, 0.15f, 0.05f, detail.cell(0.07f)),
                builder.diffuse("floor", {0.55f, 0.54f, 0.52f}));
  addPanel(builder, "amber", {3.0f, 1.3f, 0.3f}, {-1.75f, 0.72f, -0.25f}, 72.0f, detail);
  addPanel(builder, "blue", {0.25f, 0.85f, 3.2f}, {1.75f, 0.72f, -0.25f}, -72.0f, detail);

  const int knot =
      builder.place("knot", shapes::torusKnot(2, 3, 0.34f, 0.15f, 0.085f, detail(220), detail(18)),
                    builder.diffuse("chalk", {0.78f, 0.77f, 0.75f}), {0, 0.72f, 0});
  addRound(builder, knot, {0, 0.72f, 0.0f}, {1.0f, 0.55f}, kPi);
  addTurn(builder, knot, glm::normalize(glm::vec3(0.3f, 1.0f, 0.15f)), 1.0f);
  const int ball = builder.place("red ball", shapes::icosphere(0.26f, detail(14)),
                                 builder.diffuse("red", {0.75f, 0.1f, 0.06f}), {0, 0.27f, 0});
  addRound(builder, ball, {0, 0.27f, 0.1f}, {0.85f, 0.75f}, 0.6f);
  builder.place("white ball", shapes::icosphere(0.3f, detail(14)), builder.diffuse("white", glm::vec3(0.8f)),
                {0.0f, 0.31f, -0.95f});

  Light lamp;
  lamp.name = "lamp";
  lamp.intensity = {1.3f, 1.2f, 1.1f};
  const int light = builder.light(lamp, {0.0f, 1.9f, 0.6f});
  addRound(builder, light, {0.0f, 1.9f, 0.2f}, {1.3f, 0.8f}, -kPi / 2);
  builder.camera({0.0f, 2.5f, 5.6f}, {0.0f, 0.38f, -0.1f}, 33);
  builder.sky("uniform?intensity=0.03");
  return builder.finish();
}

}  // namespace gloam
