// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Rooms: walls are closed slabs, finely tessellated on the inside only, so that nothing leaks behind their edges.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin_shapes.h"
#include "scene/mesh_repair.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;

/// Where a wall runs on into its neighbours.
struct Overlap {
  bool u_start = false, u_end = false, v_start = false, v_end = false;
};

/// Walls end so far within one another: what both reach to would flicker, seen from outside.
constexpr float kHair = 0.003f;

/// A wall: its inner face spans edge_u and edge_v (which runs down) from `origin`; `thickness` behind it stands the rest of a
/// closed slab, coarse, since nobody sees it. UVs are metres.
Mesh wall(const glm::vec3& origin, const glm::vec3& edge_u, const glm::vec3& edge_v, float thickness,
          float cell, const Overlap& over) {
  const glm::vec3 u = glm::normalize(edge_u), v = glm::normalize(edge_v);
  const float overlap = thickness - kHair;
  const std::vector<float> us =
      shapes::spaced(glm::length(edge_u), cell, over.u_start ? overlap : 0.0f, over.u_end ? overlap : 0.0f);
  const std::vector<float> vs =
      shapes::spaced(glm::length(edge_v), cell, over.v_start ? overlap : 0.0f, over.v_end ? overlap : 0.0f);
  Mesh mesh = shapes::patch(origin, u, v, us, vs);
  const std::vector<float> whole = {0.0f, 1.0f};
  const glm::vec3 corner = origin + us.front() * u + vs.front() * v, back = glm::cross(u, v) * thickness;
  const glm::vec3 along_u = (us.back() - us.front()) * u, along_v = (vs.back() - vs.front()) * v;
  shapes::append(mesh, shapes::patch(corner + along_u + back, -along_u, along_v, whole, whole));
  shapes::append(mesh, shapes::patch(corner + back, along_u, -back, whole, whole));
  shapes::append(mesh, shapes::patch(corner + along_v, along_u, back, whole, whole));
  shapes::append(mesh, shapes::patch(corner + back, -back, along_v, whole, whole));
  shapes::append(mesh, shapes::patch(corner + along_u, back, along_v, whole, whole));
  return mesh;
}

/// A ceiling of 2 by 2 metres at that height, a square hole of half side `hole` in its middle, open to the front.
Mesh ceilingWithHole(float height, float hole, float thickness, float cell) {
  const float overlap = thickness - kHair;
  const auto lines = [&](bool overlap_end) {
    std::vector<float> all = shapes::spaced(1.0f - hole, cell, overlap, 0.0f);
    const int n = std::max(2, int(std::ceil(2.0f * hole / cell)));
    for (int i = 1; i <= n; ++i) all.push_back(1.0f - hole + 2.0f * hole * float(i) / float(n));
    for (const float x : shapes::spaced(1.0f - hole, cell, 0.0f, overlap_end ? overlap : 0.0f)) {
      if (x > 0.0f) all.push_back(1.0f + hole + x);
    }
    return all;
  };
  // Looking up: u to the right, v towards the back wall, first the open front.
  std::vector<float> depth = lines(false);
  for (float& z : depth) z = 2.0f - z;
  std::reverse(depth.begin(), depth.end());
  Mesh mesh = shapes::patch({-1, height, 1}, {1, 0, 0}, {0, 0, -1}, lines(true), depth);
  std::vector<std::uint32_t> kept;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const glm::vec3 middle = (mesh.positions[mesh.indices[t]] + mesh.positions[mesh.indices[t + 1]] +
                              mesh.positions[mesh.indices[t + 2]]) /
                             3.0f;
    if (std::abs(middle.x) < hole && std::abs(middle.z) < hole) continue;
    kept.insert(kept.end(), mesh.indices.begin() + std::ptrdiff_t(t),
                mesh.indices.begin() + std::ptrdiff_t(t + 3));
  }
  mesh.indices = std::move(kept);
  removeUnusedVertices(mesh);
  // The sides of the hole, and the roof round it.
  const std::vector<float> along = shapes::steps(std::max(2, int(std::ceil(2.0f * hole / cell)))),
                           up = shapes::steps(3);
  const glm::vec3 top(0, height + thickness, 0), down(0, -thickness, 0);
  const float side = 2.0f * hole;
  shapes::append(mesh, shapes::patch(top + glm::vec3(-hole, 0, hole), {0, 0, -side}, down, along, up));
  shapes::append(mesh, shapes::patch(top + glm::vec3(-hole, 0, -hole), {side, 0, 0}, down, along, up));
  shapes::append(mesh, shapes::patch(top + glm::vec3(hole, 0, -hole), {0, 0, side}, down, along, up));
  shapes::append(mesh, shapes::patch(top + glm::vec3(hole, 0, hole), {-side, 0, 0}, down, along, up));
  const std::vector<float> whole = {0.0f, 1.0f};
  const float outer = 1.0f + overlap;
  shapes::append(mesh, shapes::patch(top + glm::vec3(-outer, 0, -outer), {2 * outer, 0, 0},
                                     {0, 0, outer - hole}, whole, whole));
  shapes::append(mesh, shapes::patch(top + glm::vec3(-outer, 0, hole), {2 * outer, 0, 0}, {0, 0, 1 - hole},
                                     whole, whole));
  shapes::append(mesh, shapes::patch(top + glm::vec3(-outer, 0, -hole), {outer - hole, 0, 0}, {0, 0, side},
                                     whole, whole));
  shapes::append(
      mesh, shapes::patch(top + glm::vec3(hole, 0, -hole), {outer - hole, 0, 0}, {0, 0, side}, whole, whole));
  shapes::append(mesh, shapes::patch(top + glm::vec3(-1, 0, 1), {2, 0, 0}, down, whole, whole));
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
  builder.place("floor", wall({-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, t, cell, {true, true, true, false}), white);
  builder.place("back wall", wall({-1, 2, -1}, {2, 0, 0}, {0, -2, 0}, t, cell, {true, true, true, true}),
                white);
  // The side walls end a hair behind floor and ceiling, whose fronts they would else share; the camera stands a hair beside
  // the middle, where the edges of the room would pass through centres of pixels.
  builder.place("left wall",
                wall({-1, 2, 0.998f}, {0, 0, -1.998f}, {0, -2, 0}, t, cell, {false, true, true, true}), red);
  builder.place("right wall",
                wall({1, 2, -1}, {0, 0, 1.998f}, {0, -2, 0}, t, cell, {true, false, true, true}), green);
  builder.place("ceiling", ceilingWithHole(2.0f, 0.3f, t, cell), white);
  builder.place("tall box", standing({0.3f, 0.6f, 0.3f}, 18, cell), white, {-0.36f, 0, -0.32f});
  builder.place("short box", standing({0.29f, 0.29f, 0.29f}, -17, cell), white, {0.36f, 0, 0.3f});
  Light lamp;
  lamp.name = "skylight lamp";
  lamp.type = Light::Type::kSpot;
  lamp.intensity = {9.0f, 7.6f, 5.6f};
  lamp.inner_cone_rad = 0.4f * kPi;
  lamp.outer_cone_rad = 0.49f * kPi;
  builder.light(lamp, {0, 2.0f, 0});
  builder.camera({0.0013f, 1.0021f, 5.4f}, {0.0013f, 1.0021f, 0}, 27.5f);
  builder.sky("mild");
  return builder.finish();
}

// Night in a corner of a room: a standing lamp, a spot from above, moonlight through the open side.
Scene makeLamp(const Detail& detail, NamedValues&) {
  SceneBuilder builder("lamp");
  const float cell = detail.cell(0.05f), t = 0.12f;
  builder.place("floor", wall({-2, 0, -2}, {4, 0, 0}, {0, 0, 4}, t, cell, {true, false, true, false}),
                builder.diffuse("boards", {0.42f, 0.28f, 0.17f}));
  const int plaster = builder.diffuse("plaster", {0.7f, 0.68f, 0.64f});
  builder.place("back wall",
                wall({-2, 2.6f, -2}, {4, 0, 0}, {0, -2.6f, 0}, t, cell, {true, false, false, true}), plaster);
  builder.place("left wall",
                wall({-2, 2.6f, 2}, {0, 0, -4}, {0, -2.6f, 0}, t, cell, {false, true, false, true}),
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
  moon.intensity = {0.34f, 0.46f, 0.72f};
  builder.light(moon, {0, 3, 0}, {-0.8f, -1.0f, -0.55f});
  builder.camera({2.6f, 2.1f, 4.8f}, {-0.15f, 0.75f, -0.6f}, 35);
  return builder.finish();
}

}  // namespace gloam
