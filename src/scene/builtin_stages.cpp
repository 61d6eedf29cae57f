// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Objects on a plinth: materials side by side, soft shadows, rigid motion.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;
using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;

Mesh turned(Mesh mesh, float angle_deg, const glm::vec3& axis) {
  return shapes::transformed(std::move(mesh), glm::rotate(glm::mat4(1.0f), glm::radians(angle_deg), axis));
}

void addTurn(SceneBuilder& builder, int node, float seconds, const glm::vec3& axis, float turns) {
  AnimationChannel& channel = builder.channel(node, Path::kRotation, Interpolation::kLinear);
  const int keys = 16;  // well below half a turn from key to key
  for (int k = 0; k <= keys; ++k) {
    const float t = float(k) / float(keys);
    addKey(channel, seconds * t, glm::angleAxis(2 * kPi * turns * t, axis));
  }
}

}  // namespace

Scene makeSpheres(const Detail& detail, NamedValues&) {
  SceneBuilder builder("spheres");
  builder.place("plinth", shapes::slab(2.35f, 2.0f, 0.25f, 0.06f, detail.cell(0.045f)),
                builder.diffuse("plinth", {0.2f, 0.205f, 0.22f}));
  const std::array<glm::vec3, 5> hues = {{{0.68f, 0.13f, 0.09f},
                                          {0.74f, 0.42f, 0.08f},
                                          {0.22f, 0.45f, 0.16f},
                                          {0.08f, 0.33f, 0.5f},
                                          {0.36f, 0.17f, 0.44f}}};
  const std::array<glm::vec3, 5> metals = {{{1.0f, 0.77f, 0.34f},
                                            {0.95f, 0.64f, 0.54f},
                                            {0.91f, 0.92f, 0.92f},
                                            {0.56f, 0.57f, 0.58f},
                                            {0.9f, 0.72f, 0.4f}}};
  const std::array<float, 5> roughness = {0.15f, 0.3f, 0.45f, 0.6f, 0.8f};
  const float radius = 0.33f;
  for (std::size_t i = 0; i < 5; ++i) {
    const float x = 0.9f * (float(i) - 2.0f);
    const std::string number = std::to_string(i + 1);
    const int frequency = detail(16);
    builder.place("diffuse " + number, shapes::icosphere(radius, frequency),
                  builder.diffuse("diffuse " + number, hues[i]), {x, radius, 1.25f});
    builder.place("glossy " + number, shapes::icosphere(radius, frequency),
                  builder.glossy("glossy " + number, {0.03f, 0.12f, 0.13f}, roughness[i]), {x, radius, 0.0f});
    builder.place("metal " + number, shapes::icosphere(radius, frequency),
                  builder.metal("metal " + number, metals[i], roughness[i]), {x, radius, -1.25f});
  }
  builder.camera({0.7f, 5.4f, 7.6f}, {0, -0.05f, 0.0f}, 32);
  builder.sky("mild");
  return builder.finish();
}

Scene makeShadow(const Detail& detail, NamedValues&) {
  SceneBuilder builder("shadow");
  builder.place("plinth", shapes::slab(1.7f, 1.7f, 0.2f, 0.05f, detail.cell(0.024f)),
                builder.diffuse("plaster", {0.74f, 0.72f, 0.68f}));
  const glm::vec3 middle(0, 0.86f, 0);
  const int around = detail(96), across = detail(24);
  builder.place("outer ring", turned(shapes::torus(0.7f, 0.075f, around, across), 78, {1, 0, 0.35f}),
                builder.diffuse("terracotta", {0.62f, 0.2f, 0.1f}), middle);
  builder.place("middle ring", turned(shapes::torus(0.5f, 0.065f, around, across), 60, {0.2f, 0, -1}),
                builder.diffuse("ochre", {0.75f, 0.5f, 0.14f}), middle);
  builder.place("inner ring", turned(shapes::torus(0.335f, 0.05f, around, across), 25, {1, 0, 0.4f}),
                builder.diffuse("verdigris", {0.13f, 0.42f, 0.38f}), middle);
  builder.place("ball", shapes::icosphere(0.18f, detail(12)), builder.diffuse("chalk", glm::vec3(0.8f)),
                middle);
  builder.camera({1.6f, 2.3f, 4.3f}, {0, 0.55f, 0}, 32);
  builder.sky("studio?rotation=-65");
  return builder.finish();
}

Scene makeBronze(const Detail& detail, NamedValues&) {
  SceneBuilder builder("bronze");
  constexpr float kSheen = 0.62f;  // a Phong exponent of 11.5: what five or six bands of light show
  const int slate = builder.metal("polished slate", {0.5f, 0.52f, 0.56f}, kSheen);
  builder.material(slate).metallic = 0.65f;
  builder.place("floor", shapes::slab(1.8f, 1.8f, 0.14f, 0.04f, detail.cell(0.036f)), slate);
  builder.place(
      "knot",
      turned(shapes::torusKnot(2, 3, 0.4f, 0.19f, 0.115f, detail(240), detail(24)), -72, {1, 0, 0.1f}),
      builder.metal("bronze", {0.86f, 0.56f, 0.3f}, kSheen), {-0.1f, 0.62f, -0.1f});
  builder.place("silver ball", shapes::icosphere(0.27f, detail(15)),
                builder.metal("silver", {0.93f, 0.92f, 0.9f}, kSheen), {0.86f, 0.27f, 0.34f});
  builder.place("red ball", shapes::icosphere(0.2f, detail(12)),
                builder.diffuse("red clay", {0.72f, 0.12f, 0.07f}), {0.36f, 0.2f, 0.86f});
  builder.place("blue ball", shapes::icosphere(0.24f, detail(12)),
                builder.diffuse("blue glaze", {0.06f, 0.22f, 0.6f}), {-0.86f, 0.24f, 0.5f});
  builder.camera({0.9f, 2.1f, 4.0f}, {0, 0.42f, 0.05f}, 32);
  builder.sky("studio?rotation=-65");
  return builder.finish();
}

// Sloan, Kautz, Snyder 2002 show a ring's caustic. Polished: its lobe is sharper than any number of bands.
Scene makeCaustic(const Detail& detail, NamedValues&) {
  SceneBuilder builder("caustic");
  builder.place("plaster", shapes::slab(1.5f, 1.5f, 0.16f, 0.04f, detail.cell(0.018f)),
                builder.diffuse("plaster", {0.68f, 0.67f, 0.64f}));
  constexpr float kInside = 0.7f, kThickness = 0.06f, kHeight = 0.42f, kRound = 0.03f;
  const float middle = kInside + 0.5f * kThickness;
  const auto up =
      shapes::line({kInside + kThickness, kRound}, {kInside + kThickness, kHeight - kRound}, detail(4));
  const auto over = shapes::arc({middle, kHeight - kRound}, kRound, 0.0f, kPi, detail(10));
  const auto down = shapes::line({kInside, kHeight - kRound}, {kInside, kRound}, detail(4));
  const auto under = shapes::arc({middle, kRound}, kRound, kPi, 2.0f * kPi, detail(10));
  auto profile = shapes::joined({up, over, down, under});
  std::reverse(profile.begin(), profile.end());
  builder.place("ring", shapes::revolve({profile}, detail(160)),
                builder.metal("gold", {1.0f, 0.78f, 0.34f}, 0.08f), {0, 0.001f, 0});
  builder.camera({0.3f, 2.9f, 3.3f}, {0, 0.08f, 0.05f}, 32);
  builder.sky("studio?rotation=-65");
  return builder.finish();
}

Scene makeMobile(const Detail& detail, NamedValues&) {
  constexpr float kSeconds = 8.0f;
  SceneBuilder builder("mobile");
  builder.place("ground", shapes::slab(2.2f, 2.2f, 0.2f, 0.05f, detail.cell(0.035f)),
                builder.diffuse("ground", {0.36f, 0.35f, 0.33f}));
  const int knot =
      builder.place("knot", shapes::torusKnot(2, 3, 0.46f, 0.2f, 0.105f, detail(260), detail(20)),
                    builder.diffuse("coral", {0.72f, 0.2f, 0.13f}), {0, 0.95f, 0});
  addTurn(builder, knot, kSeconds, glm::normalize(glm::vec3(0.35f, 1, 0.2f)), 1.0f);

  const int carousel = builder.node("carousel");
  addTurn(builder, carousel, kSeconds, {0, 1, 0}, -1.0f);
  const std::array<glm::vec3, 4> hues = {
      {{0.1f, 0.36f, 0.55f}, {0.8f, 0.58f, 0.12f}, {0.25f, 0.48f, 0.2f}, {0.78f, 0.76f, 0.72f}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const float angle = 0.5f * kPi * float(i), radius = 0.2f + 0.05f * float(i % 3);
    const std::string number = std::to_string(i + 1);
    const glm::vec3 low(1.35f * std::sin(angle), radius, 1.35f * std::cos(angle));
    const int ball = builder.place("ball " + number, shapes::icosphere(radius, detail(14)),
                                   builder.diffuse("paint " + number, hues[i]), low, carousel);
    // Bounces: parabolas, as cubic splines have them exactly; 2, 3 or 4 in eight seconds of different height.
    const int bounces = 4 + int(i);
    const float duration = kSeconds / float(bounces), height = 0.12f * duration * duration;
    AnimationChannel& channel = builder.channel(ball, Path::kTranslation, Interpolation::kCubicSpline);
    for (int k = 0; k <= 2 * bounces; ++k) {
      const bool top = k % 2 == 1;
      const float slope = 4.0f * height / duration;
      channel.times_s.push_back(0.5f * duration * float(k));
      for (const glm::vec3& v :
           {glm::vec3(0, top ? 0.0f : -slope, 0), low + glm::vec3(0, top ? height : 0.0f, 0),
            glm::vec3(0, top ? 0.0f : slope, 0)}) {
        channel.values.insert(channel.values.end(), {v.x, v.y, v.z});
      }
    }
  }
  builder.camera({1.4f, 2.9f, 5.2f}, {0, 0.5f, 0}, 35);
  builder.sky("mild");
  return builder.finish();
}

}  // namespace gloam
