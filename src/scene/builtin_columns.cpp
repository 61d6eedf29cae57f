// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// An arcade: five columns carry four round arches before a red wall, under a flat ceiling; two steps lead down to a court.
#include <cmath>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;

// Plan: columns stand on z = 0 at x = -2 bay … 2 bay, the wall behind at z = -kDepth, steps and court in front.
constexpr int kBays = 4;
constexpr float kBay = 1.7f;  // from column to column
constexpr float kDepth = 2.3f;
constexpr float kSpring = 2.0f;  // height at which arches begin
constexpr float kArch = 0.64f;   // their inner radius
constexpr float kTop = 3.05f;    // of the arcade's wall
constexpr float kWall = 0.3f;    // its thickness
constexpr float kStep = 0.16f;
constexpr float kHalfLength = 0.5f * kBay * kBays + 0.5f * (kBay - 2.0f * kArch);

/// A column from y = 0 to kSpring: square plinth, torus base, swelling shaft, cushion, abacus.
Mesh column(const Detail& detail) {
  const float plinth = 0.1f, abacus = 0.1f, r = 0.155f;
  const float bottom = plinth + 0.1f, top = kSpring - abacus - 0.16f;
  std::vector<shapes::ProfilePoint> shaft;
  const int n = detail(26);
  for (int i = 0; i <= n; ++i) {
    const float t = float(i) / float(n);  // from the top down
    const float swelling = 1.0f + 0.05f * std::sin(kPi * t) + 0.1f * t;
    shaft.push_back({0.86f * r * swelling, top + t * (bottom - top)});
  }
  const float neck = shaft.front().radius, foot = shaft.back().radius;
  shaft.push_back({foot, bottom - 0.03f});  // into the base
  // The cushion: round from within the abacus in to the neck.
  const auto cushion =
      shapes::arc({neck, kSpring - abacus - 0.08f}, 0.1f, 0.31f * kPi, -0.5f * kPi, detail(8));
  Mesh mesh = shapes::revolve(
      {shapes::line({0.0f, cushion.front().height}, cushion.front(), 2), cushion, shaft,
       // The base begins within the shaft, and ends within the plinth.
       shapes::arc({foot - 0.005f, plinth + 0.049f}, 0.05f, 0.5f * kPi, -0.5f * kPi, detail(7))},
      detail(28));
  shapes::append(mesh, shapes::moved(shapes::roundedBox({r + 0.07f, 0.5f * plinth, r + 0.07f}, 0.012f,
                                                        detail.cell(0.08f), 2),
                                     {0, 0.5f * plinth, 0}));
  shapes::append(mesh, shapes::moved(shapes::roundedBox({r + 0.06f, 0.5f * abacus, r + 0.06f}, 0.012f,
                                                        detail.cell(0.08f), 2),
                                     {0, kSpring - 0.5f * abacus, 0}));
  return mesh;
}

/// One bay of the arcade's wall, from the middle of a pier to the middle of the next: both faces, the arch's underside.
Mesh archBay(const Detail& detail) {
  const int along = detail(40), up = detail(12), through = detail(6);
  const float half_bay = 0.5f * kBay;
  // u runs left to right. Over the piers beside the arch its lower edge is level.
  const auto lower = [&](float u) {
    const float pier = half_bay - kArch, x = -half_bay + u * kBay;
    (void)pier;
    const float inside = kArch * kArch - x * x;
    return glm::vec2(x, kSpring + (inside > 0.0f ? std::sqrt(inside) : 0.0f));
  };
  // Points crowd where the arch is steep: x = -R cos a between the piers.
  const auto spread = [&](float u) {
    const float pier_share = 0.12f;
    const float left = (half_bay - kArch) / kBay;
    if (u < pier_share) return left * u / pier_share;
    if (u > 1.0f - pier_share) return 1.0f - left * (1.0f - u) / pier_share;
    const float a = kPi * (u - pier_share) / (1.0f - 2.0f * pier_share);
    return 0.5f - kArch * std::cos(a) / kBay;
  };
  const auto face = [&](float u, float v, float z) {
    const glm::vec2 edge = lower(spread(u));
    return glm::vec3(edge.x, kTop + v * (edge.y - kTop), z);
  };
  Mesh mesh = shapes::surface(along, up, [&](float u, float v) {
    return shapes::SurfacePoint{face(u, v, 0.5f * kWall), {0, 0, 1}, {1, 0, 0}};
  });
  shapes::append(mesh, shapes::surface(along, up, [&](float u, float v) {
                   return shapes::SurfacePoint{face(1.0f - u, v, -0.5f * kWall), {0, 0, -1}, {-1, 0, 0}};
                 }));
  // Underside of the arch: seen from below, u from left to right and v from the back to the front.
  shapes::append(mesh, shapes::surface(detail(36), through, [&](float u, float v) {
                   const float a = kPi * (1.0f - u);
                   const glm::vec3 radial(std::cos(a), std::sin(a), 0.0f);
                   return shapes::SurfacePoint{kArch * radial + glm::vec3(0, kSpring, kWall * (0.5f - v)),
                                               -radial,
                                               {std::sin(a), -std::cos(a), 0}};
                 }));
  return mesh;
}

Mesh vase(const Detail& detail) {
  const auto bulge = [](float t) {
    return 0.085f + 0.2f * std::pow(std::sin(kPi * std::pow(t, 0.8f)), 1.3f);
  };
  std::vector<shapes::ProfilePoint> outside;
  const int n = detail(28);
  for (int i = 0; i <= n; ++i) {
    const float t = 1.0f - float(i) / float(n);
    outside.push_back({bulge(t * 0.93f) + 0.05f * t * t * t * t, 0.03f + 0.62f * t});
  }
  const shapes::ProfilePoint mouth = outside.front();
  const float wall = 0.016f;
  std::vector<shapes::ProfilePoint> inside;
  for (int i = 0; i <= n / 2; ++i) {
    const float t = 0.5f + 0.5f * float(i) / float(n / 2);
    inside.push_back({bulge(t * 0.93f) + 0.05f * t * t * t * t - 2.0f * wall, 0.03f + 0.62f * t});
  }
  const shapes::ProfilePoint rim{mouth.radius - wall, mouth.height};
  return shapes::revolve({shapes::line({0, inside.front().height}, inside.front(), 3),
                          shapes::joined({inside, shapes::arc(rim, wall, kPi, 0.0f, 6), outside}),
                          shapes::line(outside.back(), {outside.back().radius * 1.25f, 0.0f}, 2)},
                         detail(40));
}

void addArcade(SceneBuilder& builder, const Detail& detail) {
  const int stone = builder.diffuse("limestone", {0.72f, 0.66f, 0.55f});
  const int columns = builder.mesh("column", column(detail), stone);
  const int node = builder.node("columns");
  builder.at(node).meshes = {columns};
  for (int i = 0; i <= kBays; ++i) {
    glm::mat4 stands(1.0f);
    stands[3] = glm::vec4(kBay * (float(i) - 0.5f * kBays), 0, 0, 1);
    builder.at(node).instances.push_back(stands);
  }
  const int bays = builder.mesh("arch", archBay(detail), stone);
  const int arches = builder.node("arches");
  builder.at(arches).meshes = {bays};
  for (int i = 0; i < kBays; ++i) {
    glm::mat4 stands(1.0f);
    stands[3] = glm::vec4(kBay * (float(i) - 0.5f * (kBays - 1)), 0, 0, 1);
    builder.at(arches).instances.push_back(stands);
  }
  // A moulding along the top, and the ceiling from the arcade to the wall.
  builder.place(
      "cornice",
      shapes::roundedBox({kHalfLength + 0.08f, 0.09f, 0.5f * kWall + 0.09f}, 0.03f, detail.cell(0.1f), 3),
      stone, {0, kTop + 0.09f, 0});
}

/// A level from a wall at `back` to a rounded edge at `front` and a riser of one step below it. It runs on under the wall
/// and into the ground, with a line of vertices just before each.
Mesh flight(float back, float front, float y, const std::vector<float>& xs, float cell) {
  const float round = 0.02f, buried = 0.08f;
  std::vector<glm::vec2> profile;
  for (const float z : shapes::spaced(front - round - back, cell, buried, 0.0f))
    profile.emplace_back(back + z, y);
  for (int i = 1; i < 5; ++i) {
    const float a = 0.5f * kPi * float(i) / 5.0f;
    profile.emplace_back(front - round + round * std::sin(a), y - round + round * std::cos(a));
  }
  for (const float d : shapes::spaced(kStep - round, cell, 0.0f, buried))
    profile.emplace_back(front, y - round - d);
  return shapes::extrude(profile, xs);
}

void addFloors(SceneBuilder& builder, const Detail& detail, float front) {
  const float cell = detail.cell(0.055f), coarse = detail.cell(0.09f);
  const auto across = [](float half, float size, float overlap_end) {
    std::vector<float> xs = shapes::spaced(2.0f * half, size, 0.0f, overlap_end);
    for (float& x : xs) x -= half;
    return xs;
  };
  builder.place("floor", flight(-kDepth, front, 0.0f, across(kHalfLength - 0.02f, cell, 0.1f), cell),
                builder.diffuse("flagstones", {0.6f, 0.55f, 0.46f}));
  builder.place("step", flight(front, front + 0.36f, -kStep, across(kHalfLength + 0.4f, cell, 0.0f), cell),
                builder.diffuse("step stone", {0.62f, 0.57f, 0.48f}));
  builder.place(
      "court",
      shapes::patch({0, -2 * kStep, front + 0.36f}, {1, 0, 0}, {0, 0, 1},
                    across(kHalfLength + 1.2f, coarse, 0.0f), shapes::spaced(2.9f, coarse, 0.1f, 0.0f)),
      builder.diffuse("sand", {0.6f, 0.5f, 0.36f}));
}

/// The red wall, a blue one at the right end, the ceiling; and what closes the arcade against the sky behind it.
void addWalls(SceneBuilder& builder, const Detail& detail) {
  const float cell = detail.cell(0.055f), coarse = detail.cell(0.09f), length = 2.0f * kHalfLength, in = 0.1f;
  const float inside = length - 0.02f;  // from the open left end to the blue wall
  const std::vector<float> heights = shapes::spaced(kTop, cell, in, in);
  builder.place("red wall",
                shapes::patch({-kHalfLength, kTop, -kDepth}, {1, 0, 0}, {0, -1, 0},
                              shapes::spaced(inside, cell, 0.0f, in), heights),
                builder.diffuse("red plaster", {0.62f, 0.13f, 0.07f}));
  const float deep = kDepth - 0.5f * kWall;
  builder.place("blue wall",
                shapes::patch({kHalfLength - 0.02f, kTop, -kDepth}, {0, 0, 1}, {0, -1, 0},
                              shapes::spaced(deep, cell, in, in), heights),
                builder.diffuse("blue plaster", {0.12f, 0.25f, 0.42f}));
  builder.place("ceiling",
                shapes::patch({-kHalfLength, kTop, -0.5f * kWall}, {1, 0, 0}, {0, 0, -1},
                              shapes::spaced(inside, coarse, 0.0f, in), shapes::spaced(deep, coarse, in, in)),
                builder.diffuse("ceiling", {0.75f, 0.72f, 0.65f}));
  const int lime = builder.diffuse("lime wash", {0.7f, 0.68f, 0.62f});
  const float roof = kTop + 0.18f, behind = -kDepth - 0.12f, down = roof + 2.0f * kStep;
  Mesh outside = shapes::patch({-kHalfLength, roof, behind}, {1, 0, 0}, {0, 0, 1},
                               shapes::spaced(length + 0.1f, 0.4f), shapes::spaced(-behind, 0.4f));
  shapes::append(outside,
                 shapes::patch({kHalfLength + 0.1f, roof, 0.5f * kWall}, {0, 0, -1}, {0, -1, 0},
                               shapes::spaced(0.5f * kWall - behind, 0.3f), shapes::spaced(down, 0.3f)));
  shapes::append(outside, shapes::patch({kHalfLength + 0.1f, roof, behind}, {-1, 0, 0}, {0, -1, 0},
                                        shapes::spaced(length + 0.1f, 0.4f), shapes::spaced(down, 0.4f)));
  // What closes the gap between the last arch and the sheet beside it, a little behind the arcade's face.
  const float arches_end = 0.5f * kBay * float(kBays) - 0.02f;
  shapes::append(outside, shapes::patch({arches_end, roof, 0.5f * kWall - 0.005f}, {1, 0, 0}, {0, -1, 0},
                                        shapes::spaced(kHalfLength + 0.1f - arches_end, 0.05f),
                                        shapes::spaced(down, 0.1f)));
  builder.place("outside", std::move(outside), lime);
}

}  // namespace

Scene makeColumns(const Detail& detail, NamedValues&) {
  SceneBuilder builder("columns");
  addArcade(builder, detail);
  addFloors(builder, detail, 0.5f * kWall + 0.22f);
  addWalls(builder, detail);
  const int clay = builder.diffuse("clay", {0.55f, 0.24f, 0.12f});
  builder.place("vase", vase(detail), clay, {-0.95f, 0, -0.95f});
  builder.place("ball", shapes::icosphere(0.3f, detail(16)), builder.diffuse("marble", {0.8f, 0.79f, 0.76f}),
                {1.05f, 0.3f, -0.75f});
  builder.camera({-2.7f, 1.3f, 4.3f}, {0.1f, 1.28f, -0.6f}, 46);
  builder.sky("mild?elevation=34&azimuth=-38");
  return builder.finish();
}

}  // namespace gloam
