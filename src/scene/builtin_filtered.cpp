// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Fine normals and gloss under several lights: in kind of Figure 1 (a) and (b) of Segovia and Wald 2008, "Radiance filtering".
#include <cmath>

#include "scene/builtin_shapes.h"
#include "scene/painted_textures.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;

int glowing(SceneBuilder& builder, const std::string& name, const glm::vec3& radiance) {
  const int material = builder.diffuse(name, glm::vec3(0.0f));
  builder.material(material).emission = radiance;
  return material;
}

/// A third of it metal: both lobes show.
int lacquer(SceneBuilder& builder, const std::string& name, const glm::vec3& color, float roughness) {
  const int material = builder.metal(name, color, roughness);
  builder.material(material).metallic = 0.3f;
  return material;
}

/// A ball whose surface itself is bumped.
Mesh bumpedBall(float radius, float height, const Detail& detail) {
  const auto place = [&](float u, float v) {
    const float across = 2 * kPi * u, down = kPi * v;
    const float bump = std::sin(14.0f * across) * std::sin(14.0f * down) * std::sin(down);
    return (radius + height * bump) *
           glm::vec3(std::sin(down) * std::sin(across), std::cos(down), std::sin(down) * std::cos(across));
  };
  return shapes::surface(detail(168), detail(112), [&](float u, float v) {
    const float step = 1e-3f, inside = std::min(std::max(v, 2.0f * step), 1.0f - 2.0f * step);
    const glm::vec3 along = place(u + step, inside) - place(u - step, inside);
    const glm::vec3 down = place(u, inside + step) - place(u, inside - step);
    return shapes::SurfacePoint{place(u, v), glm::normalize(glm::cross(down, along)), glm::normalize(along)};
  });
}

}  // namespace

Scene makeBumps(const Detail& detail, NamedValues& values) {
  SceneBuilder builder("bumps");
  const float roughness = float(values.take("roughness", 0.73, 0.3, 1));
  const int cobbles = lacquer(builder, "cobbles", {0.75f, 0.72f, 0.68f}, roughness);
  const int normals = builder.texture(paintNormals("cobble normals", 64, 64, [](float u, float v) {
    const float rows = std::sin(2 * kPi * 6 * u) * std::sin(2 * kPi * 6 * v);
    return 0.016f * rows + 0.010f * tilingNoise(u * 16, v * 16, 16, 3);
  }));
  builder.material(cobbles).normal_map.texture = normals;
  builder.place("ground", shapes::withUvScale(shapes::ground(3, 3, detail(24), detail(24)), {3, 3}), cobbles);
  builder.place("ball", bumpedBall(0.34f, 0.012f, detail),
                lacquer(builder, "ball", {0.8f, 0.78f, 0.75f}, roughness), {0, 0.36f, -0.1f});
  const glm::vec3 lamps[] = {{-1.25f, 0.95f, 0.45f}, {1.3f, 0.9f, 0.4f}, {0.15f, 1.5f, -1.0f}};
  const glm::vec3 colors[] = {{14, 1.6f, 1.2f}, {1.2f, 2.5f, 16}, {2, 14, 2}};
  for (int i = 0; i < 3; ++i) {
    const char* names[] = {"red lamp", "blue lamp", "green lamp"};
    builder.place(names[i], shapes::icosphere(0.22f, 4), glowing(builder, names[i], colors[i]), lamps[i]);
  }
  builder.camera({0.0f, 1.35f, 1.9f}, {0, 0.16f, 0.0f}, 33);
  return builder.finish();
}

namespace {

void addTable(SceneBuilder& builder, const Detail& detail) {
  const int wood = builder.glossy("table top", {0.32f, 0.18f, 0.09f}, 0.6f);
  const int steel = builder.diffuse("legs", glm::vec3(0.25f));
  builder.place("table", shapes::roundedBox({0.75f, 0.03f, 1.7f}, 0.015f, detail.cell(0.12f), 2), wood,
                {0, 0.74f, -1});
  for (const float x : {-0.55f, 0.55f}) {
    for (const float z : {-1.4f, 1.4f})
      builder.place("leg", shapes::cylinder(0.035f, 0.71f, 0.005f, detail(12), detail(3)), steel,
                    {x, 0, z - 1});
  }
  const int cloth = builder.diffuse("chair cloth", {0.1f, 0.22f, 0.42f});
  for (int i = 0; i < 6; ++i) {
    const float side = i % 2 ? 1.0f : -1.0f, x = 1.15f * side, z = -2.1f + 1.1f * float(i / 2);
    builder.place("seat", shapes::roundedBox({0.23f, 0.035f, 0.23f}, 0.02f, detail.cell(0.12f), 2), cloth,
                  {x, 0.45f, z});
    builder.place("back", shapes::roundedBox({0.03f, 0.28f, 0.22f}, 0.02f, detail.cell(0.12f), 2), cloth,
                  {x + 0.24f * side, 0.78f, z});
    builder.place("foot", shapes::cylinder(0.03f, 0.42f, 0.004f, detail(10), detail(2)), steel, {x, 0, z});
  }
}

}  // namespace

Scene makeConference(const Detail& detail, NamedValues& values) {
  SceneBuilder builder("conference");
  const float roughness = float(values.take("roughness", 0.6, 0.3, 1)), cell = detail.cell(0.3f), t = 0.1f;
  const int floor = builder.glossy("floor", {0.45f, 0.42f, 0.38f}, roughness);
  builder.material(floor).metallic = 0.3f;
  builder.material(floor).normal_map.texture =
      builder.texture(paintNormals("floor normals", 256, 256, [](float u, float v) {
        const float x = u - std::floor(u), y = v - std::floor(v);
        const float edge = std::min(std::min(x, 1 - x), std::min(y, 1 - y));
        return 0.012f * smoothStep(0.0f, 0.07f, edge) +
               0.006f * std::sin(2 * kPi * 5 * u) * std::sin(2 * kPi * 5 * v);
      }));
  builder.place("floor", shapes::withUvScale(shapes::ground(5, 7, detail(64), detail(88)), {10, 14}), floor,
                {0, 0, -0.5f});
  const int white = builder.diffuse("paint", {0.72f, 0.7f, 0.66f});
  builder.place("back wall", shapes::box({-2.5f, 0, -4 - t}, {2.5f, 2.7f, -4}, cell), white);
  builder.place("front wall", shapes::box({-2.5f, 0, 3}, {2.5f, 2.7f, 3 + t}, cell), white);
  builder.place("left wall", shapes::box({-2.5f - t, 0, -4}, {-2.5f, 2.7f, 3}, cell),
                builder.diffuse("ochre", {0.62f, 0.42f, 0.2f}));
  builder.place("right wall", shapes::box({2.5f, 0, -4}, {2.5f + t, 2.7f, 3}, cell), white);
  // Strips of ceiling with glowing ones between them: faces down.
  const float places[] = {-2.5f, -1.45f, -1.1f, 1.1f, 1.45f, 2.5f};
  const int light = glowing(builder, "panel", {7.0f, 6.7f, 6.2f});
  for (int i = 0; i < 5; ++i)
    builder.place(i % 2 ? "panel" : "ceiling",
                  shapes::patch({places[i], 2.7f, 3}, {places[i + 1] - places[i], 0, 0}, {0, 0, -7},
                                shapes::steps(detail(3)), shapes::steps(detail(20))),
                  i % 2 ? light : white);
  addTable(builder, detail);
  builder.camera({-0.9f, 1.55f, 2.85f}, {0.15f, 0.65f, -1.4f}, 52);
  return builder.finish();
}

}  // namespace gloam
