// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A floor for models that come without one. Its vertices lie on a square grid that is mapped to a disc (concentric map
// of Shirley and Chiu 1997) and drawn toward the middle, where shadows are sharp and transfer is stored a vertex.

#include <gloam/scene.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace gloam {
namespace {

constexpr float kRadiusOverScene = 3.0f;
constexpr float kGrading = 1.6f;  // radius = fraction^grading: cells near the middle are several times finer

/// From the square [-1, 1]^2 to the unit disc, squares around the middle to circles.
glm::vec2 discFromSquare(const glm::vec2& p) {
  if (p.x == 0.0f && p.y == 0.0f) return p;
  const bool x_larger = std::abs(p.x) > std::abs(p.y);
  const float radius = x_larger ? p.x : p.y;
  const float angle = x_larger ? glm::quarter_pi<float>() * (p.y / p.x)
                               : glm::half_pi<float>() - glm::quarter_pi<float>() * (p.x / p.y);
  const glm::vec2 on_disc = radius * glm::vec2(std::cos(angle), std::sin(angle));
  return on_disc * std::pow(std::abs(radius), kGrading - 1.0f);
}

Mesh groundMesh(int cells, float radius) {
  Mesh mesh;
  mesh.name = "ground";
  mesh.uv_sets.resize(1);
  for (int row = 0; row <= cells; ++row) {
    for (int column = 0; column <= cells; ++column) {
      const glm::vec2 square = 2.0f * glm::vec2(column, row) / static_cast<float>(cells) - 1.0f;
      const glm::vec2 disc = discFromSquare(square);
      mesh.positions.emplace_back(radius * disc.x, 0.0f, radius * disc.y);
      mesh.normals.emplace_back(0.0f, 1.0f, 0.0f);
      mesh.tangents.emplace_back(1.0f, 0.0f, 0.0f, 1.0f);
      mesh.uv_sets[0].push_back(0.5f + 0.5f * disc);
    }
  }
  const auto at = [cells](int column, int row) {
    return static_cast<std::uint32_t>(row * (cells + 1) + column);
  };
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      const std::uint32_t a = at(column, row), b = at(column + 1, row), c = at(column + 1, row + 1),
                          d = at(column, row + 1);
      // +X to the right and +Z toward the viewer: counter-clockwise from above.
      mesh.indices.insert(mesh.indices.end(), {a, d, c, a, c, b});
    }
  }
  return mesh;
}

}  // namespace

void addGround(Scene& scene, const glm::vec3& albedo, int cells) {
  if (cells < 1 || cells > 4096)
    throw Error("addGround", "cells must be 1 to 4096, not " + std::to_string(cells));
  const PosedScene posed = pose(scene, 0.0f);
  const glm::vec3 size = posed.bounds_max - posed.bounds_min;
  const glm::vec3 middle = 0.5f * (posed.bounds_max + posed.bounds_min);
  const float radius = kRadiusOverScene * 0.5f * std::max({size.x, size.y, size.z, 1e-3f});

  Material material;
  material.name = "ground";
  material.base_color = glm::vec4(albedo, 1.0f);
  material.metallic = 0.0f;
  material.specular = 0.0f;

  Mesh mesh = groundMesh(cells, radius);
  mesh.material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(material);

  Node node;
  node.name = "ground";
  // A hair below the lowest point, so that a flat underside does not fight with the floor for the same pixels.
  node.translation = glm::vec3(middle.x, posed.bounds_min.y - 1e-4f * size.y, middle.z);
  node.meshes.push_back(static_cast<int>(scene.meshes.size()));
  scene.meshes.push_back(std::move(mesh));
  scene.roots.push_back(static_cast<int>(scene.nodes.size()));
  scene.nodes.push_back(std::move(node));
}

}  // namespace gloam
