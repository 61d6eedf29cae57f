// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What tests ask of a mesh made by code.
#pragma once

#include <gloam/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace gloam::mesh_laws {

/// Six times the signed volume of the tetrahedra that triangles span with the origin, over six: positive where a closed
/// mesh is wound outward.
inline double signedVolume(const Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const glm::dvec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                     c = mesh.positions[mesh.indices[t + 2]];
    sum += glm::dot(a, glm::cross(b, c));
  }
  return sum / 6.0;
}

/// Indices with vertices of nearly equal position taken as one.
inline std::vector<std::uint32_t> weldedIndices(const Mesh& mesh, float tolerance = 1e-5f) {
  std::map<std::array<long, 3>, std::uint32_t> cells;
  std::vector<std::uint32_t> place(mesh.vertexCount());
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    const glm::vec3 p = mesh.positions[i] / tolerance;
    const std::array<long, 3> key = {std::lround(p.x), std::lround(p.y), std::lround(p.z)};
    bool found = false;
    for (long dx = -1; dx <= 1 && !found; ++dx) {
      for (long dy = -1; dy <= 1 && !found; ++dy) {
        for (long dz = -1; dz <= 1 && !found; ++dz) {
          const auto near = cells.find({key[0] + dx, key[1] + dy, key[2] + dz});
          if (near != cells.end()) {
            place[i] = near->second;
            found = true;
          }
        }
      }
    }
    if (!found) cells[key] = place[i] = std::uint32_t(i);
  }
  std::vector<std::uint32_t> indices;
  for (const std::uint32_t i : mesh.indices) indices.push_back(place[i]);
  return indices;
}

/// Edges of the welded mesh that are not shared by exactly two triangles running in opposite directions: 0 for a closed
/// manifold.
inline int openEdges(const Mesh& mesh) {
  const std::vector<std::uint32_t> indices = weldedIndices(mesh);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) ++uses[{indices[t + k], indices[t + (k + 1) % 3]}];
  }
  int open = 0;
  for (const auto& [edge, count] : uses) {
    const auto back = uses.find({edge.second, edge.first});
    if (count != 1 || back == uses.end() || back->second != 1) ++open;
  }
  return open;
}

/// Least cosine between a triangle's own normal and the normals of its vertices; -1 where a triangle has no area.
inline float leastNormalAgreement(const Mesh& mesh) {
  float least = 1.0f;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                    c = mesh.positions[mesh.indices[t + 2]];
    const glm::vec3 cross = glm::cross(b - a, c - a);
    if (!(glm::length(cross) > 0.0f)) return -1.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      least = std::min(least, glm::dot(glm::normalize(cross), mesh.normals[mesh.indices[t + k]]));
    }
  }
  return least;
}

/// Greatest departure from 1 of the lengths of normals and tangents, and from 0 of their cosine.
inline float frameError(const Mesh& mesh) {
  float error =
      mesh.normals.size() == mesh.vertexCount() && mesh.tangents.size() == mesh.vertexCount() ? 0.0f : 99.0f;
  for (std::size_t i = 0; i < mesh.normals.size() && i < mesh.tangents.size(); ++i) {
    const glm::vec3 n = mesh.normals[i], t(mesh.tangents[i]);
    error = std::max({error, std::abs(glm::length(n) - 1.0f), std::abs(glm::length(t) - 1.0f),
                      std::abs(glm::dot(n, t)), std::abs(std::abs(mesh.tangents[i].w) - 1.0f)});
    if (!std::isfinite(error)) return 99.0f;
  }
  return error;
}

/// Share of triangles whose UVs are mirrored against what tangents say, or have no area.
inline float wrongUvShare(const Mesh& mesh) {
  std::size_t wrong = 0;
  const std::vector<glm::vec2>& uv = mesh.uv_sets.at(0);
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const std::uint32_t a = mesh.indices[t], b = mesh.indices[t + 1], c = mesh.indices[t + 2];
    const glm::vec2 ab = uv[b] - uv[a], ac = uv[c] - uv[a];
    const float determinant = ab.x * ac.y - ab.y * ac.x;
    const glm::vec3 along_u =
        ((mesh.positions[b] - mesh.positions[a]) * ac.y - (mesh.positions[c] - mesh.positions[a]) * ab.y) *
        determinant;
    // v runs down: counter-clockwise triangles have a negative determinant where w is +1.
    const bool agrees =
        determinant * mesh.tangents[a].w < 0.0f && glm::dot(along_u, glm::vec3(mesh.tangents[a])) > 0.0f;
    if (!agrees) ++wrong;
  }
  return float(wrong) / float(std::max<std::size_t>(1, mesh.triangleCount()));
}

}  // namespace gloam::mesh_laws
