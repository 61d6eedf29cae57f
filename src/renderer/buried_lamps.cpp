// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gloam/renderer.h>

#include <cmath>

#include "spheres/winding.h"

namespace gloam {

namespace {

/// Where a mesh's corners stand in the world.
class Corners {
 public:
  Corners(const Mesh& mesh, const Instance& instance)
      : positions_(instance.deformed() ? instance.deformed_positions : mesh.positions),
        world_from_object_(instance.world_from_object) {}
  glm::vec3 at(std::uint32_t vertex) const {
    return glm::vec3(world_from_object_ * glm::vec4(positions_[vertex], 1.0f));
  }
  /// Whether a box round all of them holds the point.
  bool reach(const glm::vec3& point) const {
    glm::vec3 low(std::numeric_limits<float>::max()), high(-std::numeric_limits<float>::max());
    for (std::uint32_t i = 0; i < positions_.size(); ++i)
      low = glm::min(low, at(i)), high = glm::max(high, at(i));
    return glm::all(glm::lessThanEqual(low, point)) && glm::all(glm::lessThanEqual(point, high));
  }

 private:
  const std::vector<glm::vec3>& positions_;
  const glm::mat4& world_from_object_;
};

/// True inside a mesh that is closed about the point and faces away from it.
bool isInside(const Mesh& mesh, const Instance& instance, const glm::vec3& point) {
  const Corners corners(mesh, instance);
  if (!corners.reach(point)) return false;
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    sum += double(spheres::triangleSolidAngle(corners.at(mesh.indices[i]), corners.at(mesh.indices[i + 1]),
                                              corners.at(mesh.indices[i + 2]), point));
  const double mirrored = glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f ? -1.0 : 1.0;
  constexpr double kWhole =
      0.95 * 4.0 * 3.14159265358979;  // of the sphere of directions: a lampshade is open
  return mirrored * sum > kWhole;
}

}  // namespace

std::vector<std::string> buriedLamps(const Scene& scene, const PosedScene& posed, const glm::vec3& eye) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < posed.lights.size(); ++i) {
    const PosedLight& lamp = posed.lights[i];
    if (lamp.light.type == Light::Type::kDirectional) continue;
    for (const Instance& instance : posed.instances) {
      const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
      if (scene.materials[std::size_t(mesh.material)].alpha_mask ||
          !isInside(mesh, instance, lamp.position) || isInside(mesh, instance, eye))
        continue;
      lines.push_back(fmt::format(
          "{} is inside {}, which lets none of its light out",
          lamp.light.name.empty() ? fmt::format("lamp {}", i + 1) : fmt::format("lamp '{}'", lamp.light.name),
          mesh.name.empty() ? "a closed mesh" : fmt::format("'{}'", mesh.name)));
      break;
    }
  }
  return lines;
}

}  // namespace gloam
