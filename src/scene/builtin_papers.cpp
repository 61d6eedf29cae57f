// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Table 1 of Nichols, Wyman 2009 in kind: a teapot (6.3K triangles), a statue that turns (250K; any number, for the question
// whether cost follows it), a serpent and a hare (405K), hares that fly (417K); and 200 small things on a floor.
#include "scene/builtin_papers.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin_shapes.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kSeconds = 8.0f;

using Place = std::function<glm::vec3(float u, float v)>;

/// A surface whose normals come from differences; u runs round, v from top to bottom.
Mesh carved(int nu, int nv, const Place& at) {
  constexpr float kStep = 1e-3f;
  return shapes::surface(nu, nv, [&](float u, float v) {
    const float low = std::clamp(v, kStep, 1.0f - kStep);
    const glm::vec3 along_u = at(u + kStep, low) - at(u - kStep, low),
                    along_v = at(u, low + kStep) - at(u, low - kStep);
    return shapes::SurfacePoint{at(u, v), glm::normalize(glm::cross(along_v, along_u)), along_u};
  });
}

glm::vec3 round(float u, float radius, float height) {
  const float angle = 2.0f * kPi * u;
  return {radius * std::cos(angle), height, -radius * std::sin(angle)};
}

float bump(float x, float middle, float width) {
  const float d = (x - middle) / width;
  return std::exp(-d * d);
}

/// About `triangles` of them, twice as many round as down.
Mesh carvedOf(double triangles, const Place& at) {
  const int nv = std::max(4, int(std::lround(std::sqrt(triangles / 4.0))));
  return carved(std::max(3, int(std::lround(triangles / (2.0 * nv)))), nv, at);
}

/// A robed figure on a round seat, 1.5 m tall.
glm::vec3 statueAt(float u, float v) {
  const float closed = v < 0.12f   ? std::sqrt(std::max(0.0f, 1.0f - (1.0f - v / 0.12f) * (1.0f - v / 0.12f)))
                       : v > 0.97f ? (1.0f - v) / 0.03f
                                   : 1.0f;
  const float robe = 0.13f + 0.02f * v - 0.06f * bump(v, 0.25f, 0.05f) + 0.13f * bump(v, 0.4f, 0.1f) +
                     0.2f * bump(v, 0.68f, 0.14f) + 0.24f * bump(v, 0.93f, 0.06f);
  const float folds = v > 0.28f ? std::min(1.0f, 8.0f * (v - 0.28f)) : 0.0f;
  const float angle = 2.0f * kPi * u;
  const float carve =
      1.0f +
      folds * (0.05f * std::sin(7.0f * angle + 9.0f * v) + 0.025f * std::sin(19.0f * angle - 26.0f * v)) +
      (v > 0.86f ? 0.08f * std::abs(std::sin(8.0f * angle)) : 0.0f) +
      (v < 0.1f ? 0.03f * std::sin(24.0f * angle) * std::sin(90.0f * v) : 0.0f);
  return round(u, closed * robe * carve, 1.5f * (1.0f - (v > 0.97f ? 0.97f : v) / 0.97f));
}

/// Ball stretched and roughened.
Place furred(const glm::vec3& middle, const glm::vec3& half, float roughness) {
  return [=](float u, float v) {
    const float polar = kPi * v, across = std::sin(kPi * std::min(v, 1.0f - v));  // 0 at both poles
    const float r = 1.0f + roughness * std::sin(2.0f * kPi * 24.0f * u) * across * std::sin(34.0f * polar);
    return middle + r * half * round(u, across, std::cos(polar));
  };
}

/// A crouching hare, 0.7 m tall, of about that many triangles.
Mesh hare(double triangles) {
  Mesh mesh = carvedOf(0.45 * triangles, furred({0, 0.24f, -0.05f}, {0.2f, 0.24f, 0.3f}, 0.02f));
  shapes::append(mesh, carvedOf(0.25 * triangles, furred({0, 0.45f, 0.2f}, {0.13f, 0.14f, 0.16f}, 0.015f)));
  for (const float side : {-1.0f, 1.0f}) {
    shapes::append(mesh, carvedOf(0.08 * triangles, [&](float u, float v) {
                     const glm::vec3 p = furred({0, 0, 0}, {0.045f, 0.17f, 0.025f}, 0.0f)(u, v);
                     return glm::vec3(p.x + side * (0.06f + 0.25f * p.y), p.y + 0.66f,
                                      p.z + 0.15f - 0.3f * p.y);
                   }));
    shapes::append(mesh,
                   carvedOf(0.04 * triangles, furred({side * 0.12f, 0.05f, 0.22f}, {0.05f, 0.05f, 0.1f}, 0)));
  }
  shapes::append(mesh, carvedOf(0.06 * triangles, furred({0, 0.2f, -0.36f}, {0.08f, 0.08f, 0.08f}, 0.01f)));
  return mesh;
}

/// Scales on a tube along a curve that coils and rises.
Mesh serpent(double triangles) {
  const auto middle = [](float v) {
    const float angle = 9.5f * v, radius = 0.55f - 0.25f * v;
    return glm::vec3(radius * std::cos(angle), 0.1f + 0.75f * v * v + 0.05f * std::sin(20.0f * v) * v,
                     radius * std::sin(angle));
  };
  const Place at = [&](float u, float v) {
    const glm::vec3 along = glm::normalize(middle(v + 1e-3f) - middle(v - 1e-3f));
    const glm::vec3 side = glm::normalize(glm::cross(along, glm::vec3(0, 1, 0))),
                    up = glm::cross(side, along);
    const float ends = std::sqrt(std::max(0.0f, 1.0f - std::pow(std::abs(2.0f * v - 1.0f), 12.0f)));
    const float thick =
        0.035f + 0.07f * std::sin(kPi * std::min(1.0f, 0.15f + 0.8f * v)) + 0.05f * bump(v, 0.95f, 0.03f);
    const float angle = 2.0f * kPi * u;
    const float scales =
        1.0f + 0.06f * std::abs(std::sin(6.0f * angle + 130.0f * v) * std::sin(6.0f * angle - 130.0f * v)) +
        0.5f * std::pow(std::max(0.0f, std::cos(angle)), 40.0f) * std::abs(std::sin(60.0f * v));
    return middle(v) + ends * thick * scales * (std::cos(angle) * up + std::sin(angle) * side);
  };
  const int nu = std::max(8, int(std::sqrt(triangles / 16.0)));
  return carved(nu, int(triangles / (2.0 * nu)), at);
}

Mesh teapot(const Detail& detail) {
  using shapes::line;
  const int around = detail(56);
  const auto curve = [](float r0, float y0, float r1, float y1, float bulge, int n) {
    std::vector<shapes::ProfilePoint> run;
    for (int i = 0; i <= n; ++i) {
      const float t = float(i) / float(n);
      run.push_back({r0 + (r1 - r0) * t + bulge * std::sin(kPi * t), y0 + (y1 - y0) * t});
    }
    return run;
  };
  Mesh mesh = shapes::revolve(
      {curve(0.28f, 0.5f, 0.3f, 0.47f, 0.02f, detail(4)), curve(0.3f, 0.47f, 0.24f, 0.03f, 0.15f, detail(18)),
       line({0.24f, 0.03f}, {0.26f, 0}, detail(2))},
      around);
  shapes::append(mesh, shapes::revolve({curve(0.001f, 0.66f, 0.03f, 0.58f, 0.05f, detail(6)),
                                        curve(0.03f, 0.58f, 0.28f, 0.5f, 0.02f, detail(8))},
                                       around));
  // Spout and handle: tubes along curves in the plane z = 0.
  const auto bent = [&](const std::function<glm::vec2(float)>& middle,
                        const std::function<float(float)>& radius, int nu, int nv) {
    shapes::append(mesh, carved(nu, nv, [&](float u, float v) {
                     const glm::vec2 p = middle(v),
                                     way = glm::normalize(middle(v + 1e-3f) - middle(v - 1e-3f));
                     const float angle = 2.0f * kPi * u;
                     return glm::vec3(p + radius(v) * std::cos(angle) * glm::vec2(-way.y, way.x),
                                      radius(v) * std::sin(angle));
                   }));
  };
  bent([](float v) { return glm::vec2(0.36f + 0.36f * v, 0.18f + 0.32f * v * v * (1.6f - 0.6f * v)); },
       [](float v) { return 0.1f - 0.06f * v; }, detail(24), detail(20));
  bent([](float v) { return glm::vec2(-0.33f - 0.26f * std::sin(kPi * v), 0.14f + 0.28f * v); },
       [](float) { return 0.03f; }, detail(16), detail(30));
  return mesh;
}

/// A floor and two walls of strong colours under a spot.
struct Stage {
  SceneBuilder builder;
  int white;
  explicit Stage(const char* name, const Detail& detail) : builder(name) {
    const float cell = detail.cell(0.25f);
    white = builder.diffuse("white", {0.75f, 0.73f, 0.7f});
    builder.place("floor", shapes::box({-1.6f, -0.1f, -1.2f}, {1.6f, 0, 2.0f}, cell),
                  builder.diffuse("sand", {0.7f, 0.6f, 0.45f}));
    builder.place("back", shapes::box({-1.6f, 0, -1.3f}, {1.6f, 2.2f, -1.2f}, cell),
                  builder.diffuse("blue", {0.2f, 0.35f, 0.7f}));
    builder.place("left", shapes::box({-1.7f, 0, -1.2f}, {-1.6f, 2.2f, 2.0f}, cell),
                  builder.diffuse("red", {0.7f, 0.15f, 0.1f}));
  }
  void lamp(const glm::vec3& at, const glm::vec3& target, float intensity, float outer_deg) {
    Light lamp;
    lamp.name = "lamp";
    lamp.type = Light::Type::kSpot;
    lamp.intensity = intensity * glm::vec3(1.0f, 0.95f, 0.85f);
    lamp.outer_cone_rad = glm::radians(outer_deg);
    lamp.inner_cone_rad = 0.8f * lamp.outer_cone_rad;
    builder.light(lamp, at, target - at);
  }
  /// Turns a node about the vertical axis, `turns` times in kSeconds.
  void turn(int node, float turns) {
    AnimationChannel& channel =
        builder.channel(node, AnimationChannel::Path::kRotation, AnimationChannel::Interpolation::kLinear);
    for (int k = 0; k <= 32; ++k)
      addKey(channel, kSeconds * float(k) / 32.0f,
             glm::angleAxis(2.0f * kPi * turns * float(k) / 32.0f, glm::vec3(0, 1, 0)));
  }
  Scene finish() {
    builder.camera({1.5f, 1.35f, 4.2f}, {0, 0.65f, 0}, 32);
    return builder.finish();
  }
};

/// Triangles at detail 1 as asked, as its square beyond.
double counted(double triangles, const Detail& detail) {
  return triangles * double(detail.factor) * double(detail.factor);
}

}  // namespace

Scene makeTeapot(const Detail& detail, NamedValues&) {
  Stage stage("teapot", detail);
  stage.builder.place("teapot", teapot(detail), stage.white, {0.1f, 0, 0});
  stage.lamp({0.9f, 1.9f, 1.6f}, {-0.5f, 0.4f, -0.5f}, 16, 38);
  stage.builder.camera({1.2f, 1.0f, 3.0f}, {-0.1f, 0.4f, 0}, 32);
  return stage.builder.finish();
}

Scene makeStatue(const Detail& detail, NamedValues& values) {
  const double triangles = values.take("triangles", 250000, 500, 4e6);
  const auto roughness = float(values.take("roughness", 1.0, 0.1, 1.0));
  Stage stage("statue", detail);
  const int paint =
      roughness < 1.0f ? stage.builder.metal("bronze", {0.8f, 0.6f, 0.35f}, roughness) : stage.white;
  stage.turn(stage.builder.place("statue", carvedOf(counted(triangles, detail), statueAt), paint), 1.0f);
  stage.lamp({1.4f, 2.1f, 1.8f}, {-0.4f, 0.6f, -0.5f}, 20, 40);
  return stage.finish();
}

Scene makeSerpent(const Detail& detail, NamedValues&) {
  Stage stage("serpent", detail);
  stage.builder.place("serpent", serpent(counted(335000, detail)),
                      stage.builder.diffuse("jade", {0.35f, 0.65f, 0.4f}), {-0.45f, 0, -0.1f});
  stage.builder.place("hare", hare(counted(69700, detail)), stage.white, {0.75f, 0, 0.5f});
  stage.lamp({1.4f, 2.1f, 1.8f}, {-0.4f, 0.4f, -0.5f}, 20, 40);
  return stage.finish();
}

Scene makeFlyingHares(const Detail& detail, NamedValues&) {
  Stage stage("flying", detail);
  const int mesh = stage.builder.mesh("hare", hare(counted(69600, detail)), stage.white);
  for (int i = 0; i < 6; ++i) {
    const float angle = 2.0f * kPi * float(i) / 6.0f;
    const int node = stage.builder.node(
        "hare " + std::to_string(i), kNone,
        {0.9f * std::cos(angle) - 0.1f, 0.35f + 0.5f * float(i % 3), 0.6f * std::sin(angle) + 0.1f});
    stage.builder.at(node).meshes = {mesh};
    stage.builder.at(node).scale = glm::vec3(0.65f);
    stage.turn(node, i % 2 ? 1.0f : -1.0f);
  }
  stage.lamp({1.4f, 2.1f, 1.8f}, {-0.4f, 0.6f, -0.5f}, 20, 42);
  return stage.finish();
}

Scene makeClutter(const Detail& detail, NamedValues&) {
  Stage stage("clutter", detail);
  SceneBuilder& builder = stage.builder;
  const float cell = detail.cell(0.04f);
  const Mesh shapes[] = {
      shapes::roundedBox({0.07f, 0.09f, 0.07f}, 0.01f, cell, 2), shapes::icosphere(0.08f, detail(5)),
      shapes::moved(shapes::cylinder(0.06f, 0.18f, 0.01f, detail(16), detail(3)), {0, -0.09f, 0}),
      shapes::torus(0.06f, 0.025f, detail(20), detail(10))};
  const float heights[] = {0.09f, 0.08f, 0.09f, 0.025f};
  std::vector<int> meshes;
  for (int shape = 0; shape < 4; ++shape) {
    for (int color = 0; color < 5; ++color) {
      const glm::vec3 albedo = 0.45f + 0.3f * glm::cos(1.3f * float(color) + glm::vec3(0, 2.1f, 4.2f));
      const int paint = builder.diffuse("paint " + std::to_string(shape) + std::to_string(color), albedo);
      meshes.push_back(builder.mesh("thing", shapes[shape], paint));
    }
  }
  for (int i = 0; i < 200; ++i) {
    const int row = i / 20, column = i % 20, shape = (i * 7 + row) % 4;
    const int node =
        builder.node("thing " + std::to_string(i), kNone,
                     {-1.45f + 0.15f * float(column), heights[shape], -1.0f + 0.3f * float(row)});
    builder.at(node).meshes = {meshes[std::size_t(shape * 5 + (i * 3 + row) % 5)]};
    builder.at(node).rotation = glm::angleAxis(0.7f * float(i), glm::vec3(0, 1, 0));
  }
  stage.lamp({1.2f, 2.4f, 2.4f}, {-0.3f, 0.2f, 0.0f}, 26, 45);
  return stage.finish();
}

}  // namespace gloam
