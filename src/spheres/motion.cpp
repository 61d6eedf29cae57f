// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How a deforming object moves, for the search: a sphere is no good for two legs that part with the next step.
#include <algorithm>
#include <cmath>

#include "spheres/objects.h"

namespace gloam::spheres {
namespace {

constexpr int kInstants = 8;
constexpr std::size_t kPlaces = 3000;

/// The object's vertices at an instant, mesh after mesh; nothing where it does not deform then.
std::vector<glm::vec3> verticesAt(const SphereSet& set, const Scene& scene, float time_s) {
  std::vector<glm::vec3> vertices;
  const PosedScene posed = pose(scene, time_s);
  for (const int mesh : set.meshes) {
    const auto instance = std::ranges::find_if(
        posed.instances, [&](const Instance& i) { return i.node == set.nodes.front() && i.mesh == mesh; });
    if (instance == posed.instances.end() || !instance->deformed()) return {};
    vertices.insert(vertices.end(), instance->deformed_positions.begin(), instance->deformed_positions.end());
  }
  return vertices;
}

double areaOf(const std::vector<glm::vec3>& vertices, const std::vector<std::uint32_t>& indices) {
  double area = 0.0;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const glm::vec3 a = vertices[indices[i]];
    area += 0.5 * double(glm::length(glm::cross(vertices[indices[i + 1]] - a, vertices[indices[i + 2]] - a)));
  }
  return area;
}

}  // namespace

Motion motionOf(const Object& object, const Scene& scene) {
  Motion motion;
  const float duration_s = scene.duration_s();
  if (!object.set.deforms || !(duration_s > 0.0f)) return motion;
  std::vector<glm::vec3> rest;
  std::vector<std::uint32_t> indices;
  for (const int m : object.set.meshes) {
    const Mesh& mesh = scene.meshes[std::size_t(m)];
    for (const std::uint32_t i : mesh.indices) indices.push_back(std::uint32_t(rest.size()) + i);
    rest.insert(rest.end(), mesh.positions.begin(), mesh.positions.end());
  }
  std::vector<std::uint32_t> places = indices;
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  const std::size_t step = std::max<std::size_t>(1, places.size() / kPlaces);
  const double rest_area = areaOf(rest, indices);
  const Solid& solid = object.solid;
  for (std::size_t i = 0; i < places.size(); i += step) {
    motion.rest.push_back((rest[places[i]] - solid.origin) / solid.scale);
  }
  for (int k = 0; k < kInstants; ++k) {
    const std::vector<glm::vec3> now =
        verticesAt(object.set, scene, duration_s * float(k) / float(kInstants));
    const double area = now.empty() ? 0.0 : areaOf(now, indices);
    if (!(area > 0.0) || !std::isfinite(area)) continue;
    const float unit = float(std::sqrt(rest_area / area)) / solid.scale;
    std::vector<glm::vec3>& moved = motion.moved.emplace_back();
    for (std::size_t i = 0; i < places.size(); i += step) moved.push_back(now[places[i]] * unit);
  }
  return motion;
}

}  // namespace gloam::spheres
