// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene/assembly_hall.h"

#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin_shapes.h"
#include "scene/painted_patterns.h"
#include "scene/painted_textures.h"

namespace gloam::assembly {
namespace {

constexpr float kPi = 3.14159265f;

/// Boxes that become one mesh.
class Boxes {
 public:
  explicit Boxes(float cell) : cell_(cell) { mesh_.uv_sets.resize(1); }
  void add(const glm::vec3& low, const glm::vec3& high) {
    const glm::vec3 half = 0.5f * (high - low);
    const float radius = std::min(0.012f, 0.4f * std::min({half.x, half.y, half.z}));
    shapes::append(mesh_, shapes::moved(shapes::roundedBox(half, radius, cell_, 1), 0.5f * (low + high)));
  }
  Mesh take() { return std::move(mesh_); }

 private:
  float cell_;
  Mesh mesh_;
};

Mesh rollers(const Detail& detail) {
  const float radius = 0.045f, half_width = 0.25f;
  const Mesh one = shapes::transformed(
      shapes::moved(shapes::cylinder(radius, 2 * half_width, 0.01f, detail(14), detail(4)),
                    {0, -half_width, 0}),
      glm::rotate(glm::mat4(1.0f), 0.5f * kPi, glm::vec3(1, 0, 0)));
  Mesh all;
  for (float x = -2.24f; x < 2.3f; x += 0.16f)
    shapes::append(all, shapes::moved(one, {x, kRollers_m - radius, 0}));
  return all;
}

/// The line's frame and legs.
Mesh frame(float cell) {
  Boxes boxes(cell);
  for (const float side : {-1.0f, 1.0f}) {
    const float z = 0.285f * side;
    boxes.add({-2.3f, 0.36f, z - 0.03f}, {2.38f, 0.49f, z + 0.03f});
    for (const float x : {-1.15f, -0.38f, 0.4f, 1.15f})
      boxes.add({x - 0.04f, 0, z - 0.028f}, {x + 0.04f, 0.38f, z + 0.028f});
  }
  return boxes.take();
}

/// A housing over an end of the line, open towards the middle up to `opening`, closed outside.
void addHousing(Boxes& boxes, float inner_x, float outer_x, float opening, float top) {
  const float low = std::min(inner_x, outer_x), high = std::max(inner_x, outer_x), wall = 0.04f, z = 0.36f;
  boxes.add({low, 0, z}, {high, top, z + wall});
  boxes.add({low, 0, -z - wall}, {high, top, -z});
  boxes.add({low - 0.02f, top, -z - wall - 0.02f}, {high + 0.02f, top + wall, z + wall + 0.02f});
  const float end = outer_x < inner_x ? low : high - wall, mouth = outer_x < inner_x ? high - wall : low;
  const float into = z + 0.013f;  // the side walls: edges that only met theirs would have four triangles
  boxes.add({end, 0, -into}, {end + wall, top, into});
  if (opening < top - 0.05f) boxes.add({mouth, opening, -into}, {mouth + wall, top, into});
}

/// An upright tube with a wall, open above and below.
Mesh tube(float inner, float wall, float low, float high, const Detail& detail) {
  const float r = 0.5f * wall, mid = inner + r;
  return shapes::revolve(
      {shapes::joined({shapes::line({inner, low + r}, {inner, high - r}, detail(8)),
                       shapes::arc({mid, high - r}, r, kPi, 0.0f, detail(4)),
                       shapes::line({inner + wall, high - r}, {inner + wall, low + r}, detail(8)),
                       shapes::arc({mid, low + r}, r, 0.0f, -kPi, detail(4))})},
      detail(32));
}

/// Heads come down a pipe from a funnel.
Mesh pipe(const Detail& detail) {
  const float inner = 0.135f, wall = 0.022f, low = 1.3f, bend = 1.98f, high = 2.2f, wide = 0.3f,
              r = 0.5f * wall;
  const auto inside = shapes::joined({shapes::line({inner, low + r}, {inner, bend}, detail(10)),
                                      shapes::line({inner, bend}, {wide, high}, detail(5))});
  const auto rim = shapes::line({wide, high}, {wide + wall, high}, 1);
  const auto outside =
      shapes::joined({shapes::line({wide + wall, high}, {inner + wall, bend - 0.015f}, detail(5)),
                      shapes::line({inner + wall, bend - 0.015f}, {inner + wall, low + r}, detail(10)),
                      shapes::arc({inner + r, low + r}, r, 0.0f, -kPi, detail(4))});
  return shapes::revolve({inside, rim, outside}, detail(32));
}

/// The press behind the third station, brackets of pipe and rail, the arm's post.
Mesh machines(float cell) {
  const float x = kStations_m[2];
  Boxes boxes(cell);
  boxes.add({x - 0.15f, 0, -0.78f}, {x + 0.15f, 1.84f, -0.5f});
  boxes.add({x - 0.14f, 1.56f, -0.56f}, {x + 0.14f, 1.82f, 0.15f});
  boxes.add({kStations_m[1] - 0.05f, 1.68f, -1.12f}, {kStations_m[1] + 0.05f, 1.78f, -0.16f});
  for (const float at : {-1.9f, 1.9f})
    boxes.add({at - 0.03f, kRail_m + 0.03f, -1.12f}, {at + 0.03f, kRail_m + 0.08f, kRailOut_m + 0.02f});
  boxes.add({-2.0f, kRail_m, kRailOut_m - 0.03f}, {2.0f, kRail_m + 0.045f, kRailOut_m + 0.03f});
  boxes.add({kArm.x - 0.17f, 0, kArm.z - 0.17f}, {kArm.x + 0.17f, 0.06f, kArm.z + 0.17f});
  boxes.add({kArm.x - 0.085f, 0.05f, kArm.z - 0.085f},
            {kArm.x + 0.085f, kShoulder_m - 0.15f, kArm.z + 0.085f});
  return boxes.take();
}

}  // namespace

void addHall(SceneBuilder& builder, const Detail& detail) {
  const float cell = detail.cell(0.11f), coarse = detail.cell(0.16f);
  const int hall = builder.node("hall");
  const auto add = [&](Mesh mesh, int material) {
    builder.at(hall).meshes.push_back(builder.mesh("hall", std::move(mesh), material));
  };
  add(shapes::moved(shapes::withUvScale(shapes::slab(2.6f, 1.45f, 0.2f, 0.02f, cell), {3.25f, 1.8f}),
                    {0, 0, 0.25f}),
      addTiles(builder, "floor", {0.52f, 0.5f, 0.46f}, {0.42f, 0.41f, 0.4f}));
  add(shapes::moved(shapes::roundedBox({2.6f, 1.25f, 0.05f}, 0.02f, 1.4f * cell, 2), {0, 1.252f, -1.16f}),
      addPlaster(builder, "wall", {0.66f, 0.64f, 0.58f}, {0.16f, 0.4f, 0.36f}, 0.6f, 1.1f));
  add(rollers(detail), builder.diffuse("rollers", {0.46f, 0.47f, 0.49f}));
  add(frame(coarse), builder.diffuse("frame", {0.12f, 0.2f, 0.26f}));
  Boxes housings(coarse);
  addHousing(housings, -1.32f, -2.34f, 0.82f, 1.0f);
  addHousing(housings, 1.36f, 2.42f, 1.2f, 1.3f);
  const int stripes = addPainted(builder, "housings", [](float u, float v) {
    const float x = 8.0f * (u + v), f = x - std::floor(x);
    const glm::vec3 hazard = glm::mix(glm::vec3(0.06f), glm::vec3(0.82f, 0.55f, 0.04f),
                                      smoothStep(0.0f, 0.05f, f) * smoothStep(0.55f, 0.5f, f));
    return glm::mix(hazard, {0.16f, 0.38f, 0.3f}, smoothStep(0.09f, 0.1f, std::min(v, 1.0f - v)));
  });
  add(housings.take(), stripes);
  add(machines(coarse), addBelts(builder, "machines", {0.1f, 0.3f, 0.34f}, {0.14f, 0.36f, 0.4f}, 1));
  Mesh tubes = shapes::moved(tube(0.132f, 0.022f, 0.0f, kMagazineTop_m + 0.03f, detail), kMagazine);
  shapes::append(tubes, shapes::moved(pipe(detail), {kStations_m[1], 0, 0}));
  add(std::move(tubes), addBelts(builder, "tubes", {0.6f, 0.58f, 0.52f}, {0.6f, 0.1f, 0.06f}, 1));
}

}  // namespace gloam::assembly
