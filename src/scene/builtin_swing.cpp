// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// An interior with a lamp that swings: light that bounces off coloured walls follows it.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kSeconds = 4.0f, kReachRad = 0.6f;

}  // namespace

Scene makeSwing(const Detail& detail, NamedValues&) {
  SceneBuilder builder("swing");
  const float cell = detail.cell(0.12f), t = 0.1f;
  const int white = builder.diffuse("plaster", {0.74f, 0.72f, 0.68f});
  builder.place("floor", shapes::box({-2, -t, -1.5f}, {2, 0, 2.5f}, cell),
                builder.diffuse("boards", {0.5f, 0.38f, 0.26f}));
  builder.place("ceiling", shapes::box({-2, 2.6f, -1.5f}, {2, 2.6f + t, 2.5f}, cell), white);
  builder.place("back wall", shapes::box({-2, 0, -1.5f - t}, {2, 2.6f, -1.5f}, cell), white);
  builder.place("left wall", shapes::box({-2 - t, 0, -1.5f}, {-2, 2.6f, 2.5f}, cell),
                builder.diffuse("red", {0.65f, 0.12f, 0.08f}));
  builder.place("right wall", shapes::box({2, 0, -1.5f}, {2 + t, 2.6f, 2.5f}, cell),
                builder.diffuse("blue", {0.1f, 0.25f, 0.6f}));
  builder.place("table",
                shapes::moved(shapes::roundedBox({0.5f, 0.04f, 0.35f}, 0.012f, cell, 2), {0, 0.7f, 0}), white,
                {0.5f, 0, -0.3f});
  builder.place("leg", shapes::cylinder(0.06f, 0.66f, 0.01f, detail(24), detail(8)), white, {0.5f, 0, -0.3f});
  builder.place("ball", shapes::icosphere(0.22f, detail(12)), builder.diffuse("yellow", {0.75f, 0.55f, 0.1f}),
                {0.5f, 0.961f, -0.3f});
  builder.place("knot", shapes::torusKnot(2, 3, 0.3f, 0.14f, 0.08f, detail(160), detail(16)), white,
                {-0.9f, 0.5f, -0.4f});

  // A pendulum on the ceiling; its shade is open below.
  const int pivot = builder.node("pivot", kNone, {0, 2.6f, 0.4f});
  const int brass = builder.diffuse("brass paint", {0.5f, 0.38f, 0.16f});
  builder.place("cord", shapes::cylinder(0.012f, 0.7f, 0.003f, detail(12), detail(6)), brass, {0, -0.75f, 0},
                pivot);
  builder.material(brass).double_sided = true;
  builder.place("shade", shapes::revolve({shapes::line({0.05f, 0.18f}, {0.2f, 0.0f}, detail(8))}, detail(32)),
                brass, {0, -0.93f, 0}, pivot);
  Light lamp;
  lamp.name = "lamp";
  lamp.type = Light::Type::kSpot;
  lamp.intensity = {30.0f, 26.0f, 20.0f};
  lamp.inner_cone_rad = 0.5f;
  lamp.outer_cone_rad = 0.85f;
  builder.light(lamp, {0, -0.94f, 0}, {0, -1, 0}, pivot);
  AnimationChannel& swing =
      builder.channel(pivot, AnimationChannel::Path::kRotation, AnimationChannel::Interpolation::kLinear);
  constexpr int kKeys = 64;
  for (int k = 0; k <= kKeys; ++k) {
    const float s = float(k) / float(kKeys);
    addKey(swing, kSeconds * s, glm::angleAxis(kReachRad * std::sin(2.0f * kPi * s), glm::vec3(0, 0, 1)));
  }
  builder.camera({0.0f, 1.45f, 6.2f}, {0, 1.2f, 0}, 36);
  return builder.finish();
}

}  // namespace gloam
