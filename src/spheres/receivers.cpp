// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What spheres cannot stand for: a plate would take a sphere for every square of its thickness, a room would be filled.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "spheres/objects.h"

namespace gloam::spheres {
namespace {

constexpr float kMostTiles = 64.0f;  // squares as broad as it is thick that make up one side of a plate
constexpr float kFlat = 0.1f;        // least extent over the middle one
constexpr float kRoomShare =
    0.75f;  // of all directions from within that meet a wall; a box without a side has 5/6
constexpr float kRoomSize = 2.0f;  // a room is that many times as long as what stands in it
constexpr int kRoomRays = 48;

bool hits(const Soup& soup, const glm::vec3& from, const glm::vec3& way) {
  for (std::size_t t = 0; t < soup.triangleCount(); ++t) {  // Moeller, Trumbore 1997
    const glm::vec3 a = soup.corner(t, 0), ab = soup.corner(t, 1) - a, ac = soup.corner(t, 2) - a;
    const glm::vec3 p = glm::cross(way, ac);
    const float determinant = glm::dot(ab, p);
    if (determinant == 0.0f) continue;
    const glm::vec3 s = from - a;
    const float u = glm::dot(s, p) / determinant;
    if (u < 0.0f || u > 1.0f) continue;
    const glm::vec3 q = glm::cross(s, ab);
    const float v = glm::dot(way, q) / determinant;
    if (v >= 0.0f && u + v <= 1.0f && glm::dot(ac, q) / determinant > 0.0f) return true;
  }
  return false;
}

/// A place of the world that walls stand round, but that is not in the walls themselves.
bool surrounds(const Object& object, const glm::vec3& world_point) {
  if (std::abs(glm::determinant(glm::mat3(object.world_from_unit))) < 1e-30f) return false;
  const glm::vec3 p(glm::inverse(object.world_from_unit) * glm::vec4(world_point, 1.0f));
  if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > 0.5f) return false;
  if (object.solid.closed && !object.solid.inverted && object.solid.winding->inside(p)) return false;
  int blocked = 0;
  for (const glm::vec3& way : sampling::fibonacciSphere(kRoomRays))
    blocked += hits(object.solid.soup, p, way) ? 1 : 0;
  return float(blocked) >= kRoomShare * float(kRoomRays);
}

float worldSize(const Object& object) {
  const glm::mat3 m(object.world_from_unit);
  return std::max({glm::length(m[0]), glm::length(m[1]), glm::length(m[2])});
}

bool isRoom(const std::vector<Object>& objects, std::size_t index, const PosedScene& posed) {
  const Object& object = objects[index];
  if (object.set.deforms) return false;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (i == index || worldSize(objects[i]) * kRoomSize > worldSize(object)) continue;
    if (surrounds(object, glm::vec3(objects[i].world_from_unit[3]))) return true;
  }
  return std::ranges::any_of(posed.cameras, [&](const PosedCamera& camera) {
    return surrounds(object, glm::vec3(camera.world_from_view[3]));
  });
}

/// How many spheres a plate asks for. A ring is as flat as a plate, but asks for few.
float tilesOf(const Solid& solid) {
  const float thickness = solid.extents.z;
  return thickness > 0.0f ? 0.5f * solid.area / (thickness * thickness) : INFINITY;
}

}  // namespace

void markReceivers(std::vector<Object>& objects, const PosedScene& posed) {
  for (Object& object : objects) {
    if (object.solid.degenerate()) {
      object.set.receive_only = "no area";
    } else if (object.solid.flatness() < kFlat && tilesOf(object.solid) > kMostTiles) {
      object.set.receive_only = fmt::format("flat: {:.3f} as thick as broad", object.solid.flatness());
    }
  }
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].casts() && isRoom(objects, i, posed))
      objects[i].set.receive_only = "a room round other things";
  }
}

}  // namespace gloam::spheres
