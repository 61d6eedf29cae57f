// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Rooms: walls are closed slabs, finely tessellated on the inside only, so that nothing leaks behind their edges.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;

// Grid lines stop this short of a corner: a vertex exactly in the corner would lie in the plane of the next wall, half of
// its rays beyond it.
constexpr float kCornerGap_m = 0.004f;

/// Parameters 0 to 1 over a side of that length, even but for lines close to both ends.
std::vector<float> insetLines(float length, float cell) {
  const int n = std::max(2, int(std::ceil(length / cell)));
  std::vector<float> lines = shapes::steps(n);
  const float gap = kCornerGap_m / length;
  lines.insert(lines.begin() + 1, gap);
  lines.insert(lines.end() - 1, 1.0f - gap);
  return lines;
}

/// A wall: its inner face spans edge_u and edge_v (which runs down) from `origin`; `thickness` behind it stands the rest of a
/// closed slab, coarse, since nobody sees it.
Mesh wall(const glm::vec3& origin, const glm::vec3& edge_u, const glm::vec3& edge_v, float thickness,
          float cell) {
  Mesh mesh = shapes::patch(origin, edge_u, edge_v, insetLines(glm::length(edge_u), cell),
                            insetLines(glm::length(edge_v), cell));
  const glm::vec3 back = glm::normalize(glm::cross(edge_u, edge_v)) * thickness;
  const std::vector<float> whole = {0.0f, 1.0f};
  shapes::append(mesh, shapes::patch(origin + edge_u + back, -edge_u, edge_v, whole, whole));
  shapes::append(mesh, shapes::patch(origin + back, edge_u, -back, whole, whole));
  shapes::append(mesh, shapes::patch(origin + edge_v, edge_u, back, whole, whole));
  shapes::append(mesh, shapes::patch(origin + back, -back, edge_v, whole, whole));
  shapes::append(mesh, shapes::patch(origin + edge_u, back, edge_v, whole, whole));
  return mesh;
}

Mesh standing(const glm::vec3& half, float angle_deg, float cell) {
  const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), glm::radians(angle_deg), {0, 1, 0});
  return shapes::transformed(shapes::moved(shapes::roundedBox(half, 0.012f, cell, 2), {0, half.y, 0}), turn);
}

}  // namespace

// Two metres wide, high and deep, open towards the viewer; a skylight in the ceiling with a lamp in it.
Scene makeCornell(const Detail& detail, NamedValues&) {
  SceneBuilder builder("cornell");
  const float cell = detail.cell(2.0f / 56.0f), t = 0.1f;
  const int white = builder.diffuse("white", {0.74f, 0.72f, 0.68f});
  const int red = builder.diffuse("red", {0.63f, 0.065f, 0.05f}),
            green = builder.diffuse("green", {0.14f, 0.45f, 0.09f});
  builder.place("floor", wall({-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, t, cell), white);
  builder.place("back wall", wall({-1, 2, -1}, {2, 0, 0}, {0, -2, 0}, t, cell), white);
  builder.place("left wall", wall({-1, 2, 1}, {0, 0, -2}, {0, -2, 0}, t, cell), red);
  builder.place("right wall", wall({1, 2, -1}, {0, 0, 2}, {0, -2, 0}, t, cell), green);
  // The ceiling is four slabs round the skylight.
  const float h = 0.3f;
  Mesh ceiling = wall({-1, 2, 1}, {2, 0, 0}, {0, 0, h - 1}, t, cell);
  shapes::append(ceiling, wall({-1, 2, -h}, {2, 0, 0}, {0, 0, h - 1}, t, cell));
  shapes::append(ceiling, wall({-1, 2, h}, {1 - h, 0, 0}, {0, 0, -2 * h}, t, cell));
  shapes::append(ceiling, wall({h, 2, h}, {1 - h, 0, 0}, {0, 0, -2 * h}, t, cell));
  builder.place("ceiling", std::move(ceiling), white);
  builder.place("tall box", standing({0.3f, 0.6f, 0.3f}, 18, cell), white, {-0.36f, 0, -0.32f});
  builder.place("short box", standing({0.29f, 0.29f, 0.29f}, -17, cell), white, {0.36f, 0, 0.3f});
  Light lamp;
  lamp.name = "skylight lamp";
  lamp.type = Light::Type::kSpot;
  lamp.intensity = {9.0f, 7.6f, 5.6f};
  lamp.inner_cone_rad = 0.4f * kPi;
  lamp.outer_cone_rad = 0.49f * kPi;
  builder.light(lamp, {0, 2.0f, 0});
  builder.camera({0, 1, 5.4f}, {0, 1, 0}, 27.5f);
  builder.sky("mild");
  return builder.finish();
}

// Night in a corner of a room: a standing lamp, a spot from above, moonlight through the open side.
Scene makeLamp(const Detail& detail, NamedValues&) {
  SceneBuilder builder("lamp");
  const float cell = detail.cell(0.05f), t = 0.12f;
  builder.place("floor", wall({-2, 0, -2}, {4, 0, 0}, {0, 0, 4}, t, cell),
                builder.diffuse("boards", {0.42f, 0.28f, 0.17f}));
  const int plaster = builder.diffuse("plaster", {0.7f, 0.68f, 0.64f});
  builder.place("back wall", wall({-2, 2.6f, -2}, {4, 0, 0}, {0, -2.6f, 0}, t, cell), plaster);
  builder.place("left wall", wall({-2, 2.6f, 2}, {0, 0, -4}, {0, -2.6f, 0}, t, cell),
                builder.diffuse("blue", {0.16f, 0.27f, 0.42f}));
  const int wood = builder.diffuse("wood", {0.55f, 0.36f, 0.2f});
  builder.place("chest", standing({0.5f, 0.28f, 0.3f}, 12, cell), wood, {0.55f, 0, -1.25f});
  builder.place("small box", standing({0.17f, 0.15f, 0.17f}, 40, cell),
                builder.diffuse("red", {0.6f, 0.1f, 0.07f}), {0.72f, 0.56f, -1.25f});
  builder.place("crate", standing({0.24f, 0.24f, 0.24f}, 28, cell),
                builder.diffuse("yellow", {0.75f, 0.5f, 0.1f}), {0.95f, 0, 0.35f});
  builder.place("pillar", shapes::cylinder(0.13f, 1.5f, 0.02f, detail(40), detail(24)), plaster,
                {1.55f, 0, -1.5f});
  // A railing: thin bars that shadow maps find hard.
  Mesh bars;
  bars.uv_sets.resize(1);
  for (int i = 0; i < 9; ++i) {
    shapes::append(bars, shapes::moved(shapes::cylinder(0.018f, 0.62f, 0.004f, detail(12), detail(10)),
                                       {0.14f * (float(i) - 4.0f), 0, 0}));
  }
  shapes::append(bars,
                 shapes::moved(shapes::roundedBox({0.64f, 0.025f, 0.03f}, 0.012f, cell, 2), {0, 0.635f, 0}));
  builder.place("railing", std::move(bars), wood, {-0.35f, 0, 0.75f});

  // The standing lamp: foot, pole, and a shade that is open above and below, so that nothing stands in front of the light.
  const glm::vec3 foot(-1.25f, 0, -1.15f);
  const int brass = builder.diffuse("brass paint", {0.5f, 0.38f, 0.16f});
  Mesh stand = shapes::cylinder(0.17f, 0.03f, 0.01f, detail(32), 1);
  shapes::append(
      stand, shapes::moved(shapes::cylinder(0.016f, 1.28f, 0.004f, detail(12), detail(16)), {0, 0.03f, 0}));
  builder.place("lamp stand", std::move(stand), brass, foot);
  const int cloth = builder.diffuse("lampshade", {0.85f, 0.78f, 0.62f});
  builder.material(cloth).double_sided = true;
  builder.place("lampshade",
                shapes::revolve({shapes::line({0.15f, 1.72f}, {0.27f, 1.36f}, detail(10))}, detail(40)),
                cloth, foot);
  Light bulb;
  bulb.name = "bulb";
  bulb.intensity = {8.5f, 6.3f, 3.6f};
  builder.light(bulb, foot + glm::vec3(0, 1.52f, 0));
  Light spot;
  spot.name = "spot";
  spot.type = Light::Type::kSpot;
  spot.intensity = {26.0f, 27.0f, 29.0f};
  spot.inner_cone_rad = 0.26f;
  spot.outer_cone_rad = 0.42f;
  builder.light(spot, {1.5f, 2.5f, 1.7f}, {-0.42f, -1.0f, -1.05f});
  Light moon;
  moon.name = "moon";
  moon.type = Light::Type::kDirectional;
  moon.intensity = {0.3f, 0.42f, 0.7f};
  builder.light(moon, {0, 3, 0}, {-0.8f, -1.0f, -0.55f});
  builder.camera({2.6f, 2.1f, 4.8f}, {-0.15f, 0.75f, -0.6f}, 35);
  return builder.finish();
}

}  // namespace gloam
