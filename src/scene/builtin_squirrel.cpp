// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A squirrel and balls slide down an open box that leans and runs out on the ground, as in Guerrero, Jeschke, Wimmer 2008.
// Everything moves along the box's bottom: it gathers speed on the slope and loses it, both evenly, on the level part.
#include <algorithm>
#include <array>
#include <cmath>

#include "scene/builtin_shapes.h"
#include "scene/painted_patterns.h"
#include "scene/sampled_motion.h"
#include "scene/squirrel.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kSeconds = 4.0f;

/// The bottom of the box seen from the side, +X downhill: a slope, an arc, a level run.
struct Path {
  float slope_rad = 0.47f, slope_m = 2.3f, bend_m = 2.2f, level_m = 2.05f, height_m = 0.08f;
  struct Place {
    glm::vec3 position;
    float angle_rad;  // of the way on, above +X
    glm::vec3 up() const { return {-std::sin(angle_rad), std::cos(angle_rad), 0}; }
  };
  float arc() const { return bend_m * slope_rad; }
  float endOfBend() const { return slope_m + arc(); }
  float length() const { return endOfBend() + level_m; }
  Place at(float s) const {
    if (s > endOfBend()) return {{s - endOfBend(), height_m, 0}, 0.0f};
    const float angle = s > slope_m ? (endOfBend() - s) / bend_m : slope_rad;
    glm::vec3 p(-bend_m * std::sin(angle), height_m + bend_m * (1.0f - std::cos(angle)), 0);
    const float above = std::max(0.0f, slope_m - s);
    p += above * glm::vec3(-std::cos(slope_rad), std::sin(slope_rad), 0);
    return {p, -angle};
  }
};

/// What slides or rolls: from rest at `from_m` down to rest at `to_m`.
struct Slide {
  float lane_m, from_m, to_m, start_s, gain;  // gain: m / s^2 on the slope
  float at(const Path& path, float time_s) const {
    const float t = std::max(0.0f, time_s - start_s), fast_m = path.endOfBend() - from_m;
    const float gaining_s = std::sqrt(2.0f * fast_m / gain), speed = gain * gaining_s;
    if (t < gaining_s) return from_m + 0.5f * gain * t * t;
    const float left_m = to_m - path.endOfBend(), losing_s = 2.0f * left_m / speed;
    const float u = std::min(1.0f, (t - gaining_s) / losing_s);
    return path.endOfBend() + left_m * u * (2.0f - u);
  }
};

/// A bar of rectangular section along the path between two distances from its middle line and two heights over it.
Mesh bar(const Path& path, float from_m, float to_m, glm::vec2 z, glm::vec2 height, float cell) {
  const int n = std::max(2, int((to_m - from_m) / cell));
  const auto corner = [&](float s, float across, float above) {
    const Path::Place place = path.at(s);
    return place.position + above * place.up() + glm::vec3(0, 0, across);
  };
  const auto side = [&](glm::vec2 a,
                        glm::vec2 b) {  // seen from outside with a above b and the path to the right
    const int m = std::max(1, int(glm::length(b - a) / cell));
    return shapes::surface(n, m, [&](float u, float v) {
      const float s = glm::mix(from_m, to_m, u);
      const glm::vec2 c = glm::mix(a, b, v), out(b.y - a.y, a.x - b.x);
      const Path::Place place = path.at(s);
      const glm::vec3 along(std::cos(place.angle_rad), std::sin(place.angle_rad), 0);
      return shapes::SurfacePoint{corner(s, c.x, c.y), glm::vec3(0, 0, -out.x) - out.y * place.up(), along};
    });
  };
  Mesh mesh = side({z.x, height.y}, {z.y, height.y});            // top
  shapes::append(mesh, side({z.y, height.y}, {z.y, height.x}));  // towards +Z
  shapes::append(mesh, side({z.y, height.x}, {z.x, height.x}));  // bottom
  shapes::append(mesh, side({z.x, height.x}, {z.x, height.y}));  // towards -Z
  const auto end = [&](float s, float sign) {
    const glm::vec3 a = corner(s, sign > 0.0f ? z.y : z.x, height.y),
                    b = corner(s, sign > 0.0f ? z.x : z.y, height.y);
    const glm::vec3 c = corner(s, sign > 0.0f ? z.y : z.x, height.x);
    shapes::append(mesh, shapes::patch(a, b - a, c - a, shapes::steps(2), shapes::steps(2)));
  };
  end(from_m, -1.0f);
  end(to_m, 1.0f);
  return mesh;
}

constexpr float kHalfWidth = 0.92f;

/// Boards, each a node of its own and flat: none of them is worth spheres.
void addBox(SceneBuilder& builder, const Path& path, const Detail& detail) {
  const float cell = detail.cell(0.085f), end = path.length(), board = 0.03f, side = 0.04f;
  const int wood = addBoards(builder, "boards", {0.52f, 0.36f, 0.2f});
  const int rim = addBoards(builder, "rim", {0.16f, 0.3f, 0.38f});
  const int box = builder.node("box");
  const std::array<float, 4> cuts = {0.0f, path.slope_m, path.endOfBend(), end};
  const std::array<const char*, 3> names = {"slope", "bend", "level"};
  for (std::size_t i = 0; i < 3; ++i) {
    Mesh bottom =
        bar(path, cuts[i], cuts[i + 1], {-kHalfWidth - 0.02f, kHalfWidth + 0.02f}, {-board, 0.0f}, cell);
    // Boards run down the slope, and on from piece to piece.
    for (glm::vec2& uv : bottom.uv_sets[0]) uv = {2.0f * uv.y, 0.55f * glm::mix(cuts[i], cuts[i + 1], uv.x)};
    builder.place(names[i], std::move(bottom), wood, glm::vec3(0.0f), box);
  }
  const auto edge = [&](const std::string& name, float from, float to, glm::vec2 z, glm::vec2 height) {
    Mesh mesh = bar(path, from, to, z, height, cell);
    for (glm::vec2& uv : mesh.uv_sets[0]) uv = {0.25f * uv.y, uv.x};
    builder.place(name, std::move(mesh), rim, glm::vec3(0.0f), box);
  };
  edge("near side", -side, end + side, {kHalfWidth, kHalfWidth + side}, {-board - 0.015f, 0.15f});
  edge("far side", -side, end + side, {-kHalfWidth - side, -kHalfWidth}, {-board - 0.015f, 0.15f});
  const float thin = 0.012f, across = kHalfWidth - 0.001f;
  edge("upper end", -thin, 0.0f, {-across, across}, {-board - 0.012f, 0.145f});
  edge("lower end", end, end + thin, {-across, across}, {-board - 0.012f, 0.145f});
  // A board across carries the upper end.
  const glm::vec3 high = path.at(0.35f).position, half(0.04f, 0.5f * (high.y - board), 0.8f);
  builder.place("trestle", shapes::roundedBox(half, 0.012f, cell, 2), rim, {high.x, half.y, 0}, box);
}

struct Ball {
  const char* name;
  float radius;
  Slide slide;
};

void addBall(SceneBuilder& builder, const Path& path, const Ball& ball, int material, const Detail& detail) {
  const int segments = 2 * detail(20);
  const int node = builder.place(ball.name, shapes::uvSphere(ball.radius, segments, segments / 2), material);
  addMotion(builder, node, kSeconds, [=](float t) {
    const Path::Place place = path.at(ball.slide.at(path, t));
    return place.position + ball.radius * place.up() + glm::vec3(0, 0, ball.slide.lane_m);
  });
  // It rolls; its stripes stand slanted at first.
  const glm::quat slant =
      glm::angleAxis(0.7f + 2.1f * ball.slide.from_m, glm::normalize(glm::vec3(1, 0.4f, 0.6f)));
  addTurning(builder, node, kSeconds, [=](float t) {
    const float rolled = (ball.slide.at(path, t) - ball.slide.from_m) / ball.radius;
    return glm::angleAxis(-rolled, glm::vec3(0, 0, 1)) * slant;
  });
}

void addSquirrel(SceneBuilder& builder, const Path& path, const Detail& detail) {
  const int node = builder.place("squirrel", squirrel::model(std::min(0.03f, detail.cell(0.019f))),
                                 squirrel::fur(builder));
  const Slide slide{0.0f, 1.02f, path.endOfBend() + 0.98f, 0.15f, 1.12f};
  // It rests on two lines across the path, so that nothing sinks where the box bends.
  const auto ends = [=](float t) {
    const float s = slide.at(path, t);
    return std::pair(path.at(s - 0.2f).position, path.at(s + 0.2f).position);
  };
  addMotion(builder, node, kSeconds, [=](float t) {
    const auto [back, front] = ends(t);
    return 0.5f * (back + front);
  });
  addTurning(builder, node, kSeconds, [=](float t) {
    const auto [back, front] = ends(t);
    const glm::vec3 along = front - back;
    return glm::angleAxis(std::atan2(along.y, along.x), glm::vec3(0, 0, 1)) *
           glm::angleAxis(0.5f * kPi, glm::vec3(0, 1, 0));
  });
}

}  // namespace

Scene makeSquirrel(const Detail& detail, NamedValues&) {
  SceneBuilder builder("squirrel");
  const float cell = detail.cell(0.11f);
  const Path path;
  builder.place("ground", shapes::withUvScale(shapes::slab(3.6f, 2.1f, 0.2f, 0.03f, cell), {4.0f, 2.33f}),
                addTiles(builder, "ground", {0.62f, 0.6f, 0.56f}, {0.5f, 0.49f, 0.47f}), {-0.45f, 0, 0.15f});
  builder.place("back wall",
                shapes::moved(shapes::roundedBox({3.6f, 1.25f, 0.06f}, 0.02f, 1.5f * cell, 2), {0, 1.25f, 0}),
                addPlaster(builder, "wall", {0.66f, 0.64f, 0.58f}, {0.2f, 0.42f, 0.4f}, 0.74f, 1.2f),
                {-0.45f, -0.03f, -1.7f});
  addBox(builder, path, detail);
  addSquirrel(builder, path, detail);
  const float level = path.endOfBend();
  const std::array<Ball, 6> balls = {{{"beach ball", 0.24f, {0.56f, 0.5f, level + 1.0f, 0.15f, 1.12f}},
                                      {"orange ball", 0.17f, {0.6f, 1.25f, level + 1.72f, 0.0f, 1.24f}},
                                      {"blue ball", 0.2f, {-0.6f, 0.75f, level + 1.3f, 0.3f, 1.24f}},
                                      {"small ball", 0.14f, {-0.55f, 1.55f, level + 1.8f, 0.0f, 1.24f}},
                                      {"yellow ball", 0.19f, {0.02f, 1.75f, level + 1.72f, 0.0f, 1.24f}},
                                      {"green ball", 0.17f, {-0.03f, 0.2f, level + 0.12f, 0.75f, 1.05f}}}};
  const glm::vec3 white(0.8f, 0.79f, 0.76f), red(0.72f, 0.06f, 0.04f), blue(0.05f, 0.16f, 0.62f),
      yellow(0.85f, 0.6f, 0.06f), green(0.1f, 0.5f, 0.14f), orange(0.84f, 0.28f, 0.04f);
  const std::array<int, 6> paints = {
      addGores(builder, "beach", red, white, blue, 8),
      addBelts(builder, "orange belts", orange, white, 1),
      addBelts(builder, "blue belts", blue, white, 2),
      addGores(builder, "magenta gores", {0.62f, 0.06f, 0.36f}, white, white, 6),
      addChequers(builder, "yellow chequers", yellow, red, 8, 4),
      addGores(builder, "green gores", green, yellow, white, 6)};
  for (std::size_t i = 0; i < balls.size(); ++i) addBall(builder, path, balls[i], paints[i], detail);
  builder.camera({2.3f, 2.35f, 5.1f}, {-0.62f, 0.52f, -0.1f}, 37);
  builder.sky("mild?azimuth=35");
  return builder.finish();
}

}  // namespace gloam
