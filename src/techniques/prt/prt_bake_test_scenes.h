// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Options and small scenes for the tests of the bake; all materials white unless a test paints them.
#pragma once

#include <gloam/bake.h>

#include <cmath>
#include <utility>

namespace gloam::prt {

inline BakeOptions shadowed(int order = 4, int directions = 4096) {
  BakeOptions options;
  options.kind = TransferKind::kShadowed;
  options.order = order;
  options.directions = directions;
  return options;
}

inline BakeOptions interreflected(int bounces, int order = 3, int directions = 2048,
                                  int bounce_directions = 1024) {
  BakeOptions options = shadowed(order, directions);
  options.kind = TransferKind::kInterreflected;
  options.bounces = bounces;
  options.bounce_directions = bounce_directions;
  return options;
}

inline Mesh& addMesh(Scene& scene, Mesh mesh) {
  if (scene.materials.empty()) scene.materials.push_back({.metallic = 0.0f});
  Node node;
  node.meshes = {int(scene.meshes.size())};
  scene.roots.push_back(int(scene.nodes.size()));
  scene.nodes.push_back(node);
  scene.meshes.push_back(std::move(mesh));
  return scene.meshes.back();
}

inline Scene sceneOf(Mesh mesh) {
  Scene scene;
  addMesh(scene, std::move(mesh));
  return scene;
}

inline void turnInsideOut(Mesh& mesh) {
  for (glm::vec3& n : mesh.normals) n = -n;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
}

// Part of the unit sphere around +Y from the pole down to `angle`, seen from outside; columns + 1 vertices a ring, the last
// at the place of the first.
inline Mesh capMesh(float angle, int rings, int columns) {
  Mesh mesh;
  for (int r = 0; r <= rings; ++r) {
    for (int c = 0; c <= columns; ++c) {
      const double theta = double(angle) * r / rings, phi = 2.0 * 3.14159265358979 * (c % columns) / columns;
      const glm::vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(n);
      mesh.normals.push_back(n);
    }
  }
  const auto at = [&](int r, int c) { return std::uint32_t(r * (columns + 1) + c); };
  const bool closed = angle > 3.14f;
  for (int r = 0; r < rings; ++r) {
    for (int c = 0; c < columns; ++c) {
      if (r > 0) mesh.indices.insert(mesh.indices.end(), {at(r, c), at(r, c + 1), at(r + 1, c + 1)});
      if (r + 1 < rings || !closed) {
        mesh.indices.insert(mesh.indices.end(), {at(r, c), at(r + 1, c + 1), at(r + 1, c)});
      }
    }
  }
  return mesh;
}

inline Mesh sphereMesh(int rings, int columns) {
  return capMesh(3.14159265f, rings, columns);
}

// A thin open sheet that covers the share of its sphere, seen from inside.
inline Mesh bowlMesh(float share, int rings, int columns) {
  Mesh mesh = capMesh(std::acos(1.0f - 2.0f * share), rings, columns);
  turnInsideOut(mesh);
  return mesh;
}

// Centre and half sides; the normal is u x v.
inline Mesh quadMesh(const glm::vec3& center, const glm::vec3& u, const glm::vec3& v) {
  Mesh mesh;
  mesh.positions = {center - u - v, center + u - v, center + u + v, center - u + v};
  mesh.normals.assign(4, glm::normalize(glm::cross(u, v)));
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

// A floor at y = 0, from -half to half, cells x cells squares.
inline Mesh gridMesh(float half, int cells) {
  Mesh mesh;
  for (int z = 0; z <= cells; ++z) {
    for (int x = 0; x <= cells; ++x) {
      mesh.positions.push_back(
          half * glm::vec3(2.0f * float(x) / float(cells) - 1, 0, 2.0f * float(z) / float(cells) - 1));
      mesh.normals.push_back({0, 1, 0});
    }
  }
  for (int z = 0; z < cells; ++z) {
    for (int x = 0; x < cells; ++x) {
      const auto i = std::uint32_t(z * (cells + 1) + x), below = i + std::uint32_t(cells) + 1;
      mesh.indices.insert(mesh.indices.end(), {i, below, below + 1, i, below + 1, i + 1});
    }
  }
  return mesh;
}

// Seen from outside. 24 vertices with the sides' normals, or smooth ones that look out of the corners.
inline Mesh boxMesh(const glm::vec3& half, bool smooth) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 normal(0.0f), u(0.0f), v(0.0f);
      normal[axis] = side;
      u[(axis + 1) % 3] = side;
      v[(axis + 2) % 3] = 1.0f;
      const Mesh face = quadMesh(normal * half, u * half, v * half);
      for (const std::uint32_t i : face.indices)
        mesh.indices.push_back(std::uint32_t(mesh.positions.size()) + i);
      for (const glm::vec3& p : face.positions) {
        mesh.positions.push_back(p);
        mesh.normals.push_back(smooth ? glm::normalize(p / half) : normal);
      }
    }
  }
  return mesh;
}

// A bowl, a sphere in it and a box through its rim, of three colours: 600 points, much interreflection.
inline Scene crowdedScene() {
  Scene scene = sceneOf(bowlMesh(0.6f, 12, 24));
  Mesh sphere = sphereMesh(8, 16);
  for (glm::vec3& p : sphere.positions) p = p * 0.4f + glm::vec3(0.1f, 0.3f, 0.0f);
  addMesh(scene, sphere).material = 1;
  Mesh box = boxMesh(glm::vec3(0.3f), false);
  for (glm::vec3& p : box.positions) p += glm::vec3(0.9f, -0.2f, 0.1f);
  addMesh(scene, box).material = 2;
  scene.materials.push_back({.base_color = glm::vec4(0.8f, 0.3f, 0.1f, 1.0f), .metallic = 0.0f});
  scene.materials.push_back({.base_color = glm::vec4(0.2f, 0.7f, 0.4f, 1.0f), .metallic = 0.0f});
  return scene;
}

}  // namespace gloam::prt
