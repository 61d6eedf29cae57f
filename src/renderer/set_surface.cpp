// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/set_surface.h"

#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>

namespace gloam {

// Strata of the running area, two more coordinates of an additive recurrence.
std::vector<AreaPoint> pointsByArea(const Scene& scene, const SphereSet& set, std::size_t count) {
  struct Triangle {
    int mesh;
    int index;
    double end;
  };
  std::vector<Triangle> triangles;
  double total = 0.0;
  for (const int m : set.meshes) {
    const Mesh& mesh = scene.meshes.at(std::size_t(m));
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
      const glm::vec3 a = mesh.positions[mesh.indices[3 * t]], b = mesh.positions[mesh.indices[3 * t + 1]],
                      c = mesh.positions[mesh.indices[3 * t + 2]];
      total += double(glm::length(glm::cross(b - a, c - a)));
      triangles.push_back({m, int(t), total});
    }
  }
  std::vector<AreaPoint> points;
  if (!(total > 0.0) || !std::isfinite(total)) return points;
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double place = total * (double(i) + 0.5) / double(count);
    while (at + 1 < triangles.size() && triangles[at].end < place) ++at;
    auto u = float(std::fmod(0.7548776662466927 * double(i + 1), 1.0));
    auto v = float(std::fmod(0.5698402909980532 * double(i + 1), 1.0));
    if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
    points.push_back({triangles[at].mesh, {triangles[at].index, u, v}});
  }
  return points;
}

float facing(const Scene& scene, const SphereSet& set) {
  double volume = 0.0;
  for (const int m : set.meshes) {
    const Mesh& mesh = scene.meshes.at(std::size_t(m));
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
      const glm::dvec3 a = mesh.positions[mesh.indices[3 * t]], b = mesh.positions[mesh.indices[3 * t + 1]],
                       c = mesh.positions[mesh.indices[3 * t + 2]];
      volume += glm::dot(a, glm::cross(b, c));
    }
  }
  return volume < 0.0 ? -1.0f : 1.0f;
}

glm::vec3 placeOf(const Scene& scene, const SphereSet& set, const AreaPoint& at) {
  const Mesh& mesh = scene.meshes[std::size_t(at.mesh)];
  return set.shape_from_object * trace::interpolate(mesh, mesh.positions, at.point);
}

glm::vec3 normalOf(const Scene& scene, const SphereSet& set, const AreaPoint& at) {
  const Mesh& mesh = scene.meshes[std::size_t(at.mesh)];
  const std::uint32_t* corner = &mesh.indices[std::size_t(at.point.triangle) * 3];
  const glm::vec3 a = mesh.positions[corner[0]], b = mesh.positions[corner[1]], c = mesh.positions[corner[2]];
  const glm::vec3 normal = glm::inverseTranspose(set.shape_from_object) * glm::cross(b - a, c - a);
  const float length = glm::length(normal);
  return length > 0.0f ? normal / length : glm::vec3(0.0f);
}

}  // namespace gloam
