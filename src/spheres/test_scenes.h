// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What several tests of this room put spheres in.
#pragma once

#include <gloam/spheres.h>

#include "scene/builtin_shapes.h"
#include "scene/scene_builder.h"
#include "spheres/winding.h"

namespace gloam::spheres {

inline Scene sceneOf(Mesh mesh) {
  SceneBuilder builder("test");
  const int white = builder.diffuse("white", glm::vec3(0.5f));
  builder.place("thing", std::move(mesh), white);
  return builder.finish();
}

inline Soup soupOf(const Mesh& mesh) {
  return {mesh.positions, mesh.indices};
}

/// Quick and less good than the default.
inline SphereOptions quick(int count, float effort = 0.05f) {
  SphereOptions options;
  options.count = count;
  options.samples = 1000;
  options.effort = effort;
  return options;
}

/// Two squares that cross, as plants are drawn: nothing is inside.
inline Mesh crossedSheets() {
  const std::vector<float> cells = shapes::steps(4);
  Mesh mesh = shapes::patch({-1, 1, 0}, {2, 0, 0}, {0, -2, 0}, cells, cells);
  shapes::append(mesh, shapes::patch({0, 1, -1}, {0, 0, 2}, {0, -2, 0}, cells, cells));
  return mesh;
}

inline Mesh turnedInsideOut(Mesh mesh) {
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
    std::swap(mesh.indices[t], mesh.indices[t + 1]);
  for (glm::vec3& n : mesh.normals) n = -n;
  return mesh;
}

}  // namespace gloam::spheres
