// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Normals and tangents of meshes that have none. Angle weights: Thuermer, Wuethrich, "Computing Vertex Normals from
// Polygonal Facets", 1998. Tangents: dP/du of each triangle from its texture coordinates (Lengyel), summed per vertex and
// handedness; glTF's textures have v downwards, so an unmirrored triangle has a negative signed area in (u, v).
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "scene/mesh_repair.h"

namespace gloam {
namespace {

struct PositionHash {
  std::size_t operator()(const glm::vec3& p) const {
    std::uint64_t h = 1469598103934665603ull;
    for (int i = 0; i < 3; ++i)
      h = (h ^ std::bit_cast<std::uint32_t>(p[i] + 0.0f)) * 1099511628211ull, h ^= h >> 29;
    return h;
  }
};

/// One number for all vertices at the same position.
std::vector<std::uint32_t> weldByPosition(const Mesh& mesh) {
  std::unordered_map<glm::vec3, std::uint32_t, PositionHash> first;
  first.reserve(mesh.vertexCount());
  std::vector<std::uint32_t> weld(mesh.vertexCount());
  for (std::uint32_t i = 0; i < weld.size(); ++i) weld[i] = first.emplace(mesh.positions[i], i).first->second;
  return weld;
}

double angleAt(const Mesh& mesh, const std::uint32_t* triangle, int corner) {
  const glm::dvec3 p(mesh.positions[triangle[corner]]), q(mesh.positions[triangle[(corner + 1) % 3]]),
      r(mesh.positions[triangle[(corner + 2) % 3]]);
  const glm::dvec3 u = q - p, v = r - p;
  return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

std::uint32_t findRoot(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// A face's corner at a vertex and one of the two edges that start there.
struct Spoke {
  std::uint32_t vertex, other, corner;
  bool operator<(const Spoke& b) const {
    return std::tie(vertex, other, corner) < std::tie(b.vertex, b.other, b.corner);
  }
};

/// Joins corners around a vertex whose faces meet in an edge at less than the crease: returns each corner's group.
std::vector<std::uint32_t> smoothingGroups(const Mesh& mesh, const std::vector<std::uint32_t>& weld,
                                           const std::vector<glm::dvec3>& face_normals, double least_cos) {
  std::vector<Spoke> spokes;
  spokes.reserve(mesh.indices.size() * 2);
  for (std::uint32_t corner = 0; corner < mesh.indices.size(); ++corner) {
    const std::uint32_t base = corner / 3 * 3, k = corner % 3;
    for (std::uint32_t step : {1u, 2u})
      spokes.push_back({weld[mesh.indices[corner]], weld[mesh.indices[base + (k + step) % 3]], corner});
  }
  std::sort(spokes.begin(), spokes.end());
  std::vector<std::uint32_t> parent(mesh.indices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  constexpr std::size_t kMostFaces = 16;  // that meet in one edge and are all compared; two in a good mesh
  for (std::size_t i = 0; i < spokes.size(); ++i) {
    const Spoke& a = spokes[i];
    for (std::size_t j = i + 1; j < std::min(spokes.size(), i + kMostFaces); ++j) {
      const Spoke& b = spokes[j];
      if (a.vertex != b.vertex || a.other != b.other) break;
      if (glm::dot(face_normals[a.corner / 3], face_normals[b.corner / 3]) < least_cos) continue;
      parent[findRoot(parent, a.corner)] = findRoot(parent, b.corner);
    }
  }
  for (std::uint32_t corner = 0; corner < parent.size(); ++corner) parent[corner] = findRoot(parent, corner);
  return parent;
}

/// What the corners of a group add up to; stored at the group's number.
struct GroupSum {
  glm::dvec3 normal{0.0};
  double angle = 0.0;
};

std::vector<GroupSum> sumGroups(const Mesh& mesh, const std::vector<std::uint32_t>& group,
                                const std::vector<glm::dvec3>& face_normals) {
  std::vector<GroupSum> sums(group.size());
  for (std::uint32_t corner = 0; corner < group.size(); ++corner) {
    const double angle = angleAt(mesh, &mesh.indices[corner / 3 * 3], corner % 3);
    sums[group[corner]].normal += face_normals[corner / 3] * angle;
    sums[group[corner]].angle += angle;
  }
  return sums;
}

/// Scans and simplified meshes hold faces that are folded over onto their neighbours, or lie on them upside down. Such a
/// corner is no edge to be kept: given a normal of its own it would look into the body. It takes that of the greatest
/// group at its place, and adds nothing to it. What tells it from the rim of a thin body, where both sides are as wide: a
/// sheet that goes once around a point and folds over by an angle has 2 pi more of the one direction than of the other.
void joinFolds(const Mesh& mesh, const std::vector<std::uint32_t>& weld, const std::vector<GroupSum>& sums,
               std::vector<std::uint32_t>& group) {
  constexpr double kLargestShare = 0.5, kLeastOpposedCos = 0.5;  // half as wide, and turned by 120 degrees
  constexpr std::uint32_t kNoGroup = ~0u;
  std::vector<std::uint32_t> greatest(mesh.vertexCount(), kNoGroup);
  for (std::uint32_t g = 0; g < sums.size(); ++g) {
    if (group[g] != g) continue;
    std::uint32_t& best = greatest[weld[mesh.indices[g]]];
    if (best == kNoGroup || sums[g].angle > sums[best].angle) best = g;
  }
  const auto isFold = [&](std::uint32_t g, std::uint32_t best) {
    const GroupSum &a = sums[g], &b = sums[best];
    return a.angle < kLargestShare * b.angle &&
           glm::dot(a.normal, b.normal) < -kLeastOpposedCos * glm::length(a.normal) * glm::length(b.normal);
  };
  for (std::uint32_t& g : group) {
    const std::uint32_t best = greatest[weld[mesh.indices[g]]];
    if (isFold(g, best)) g = best;
  }
}

/// Makes one vertex of every pair (old vertex, key of a corner). Returns the new vertices' keys.
std::vector<std::uint32_t> splitVertices(Mesh& mesh, const std::vector<std::uint32_t>& key_of_corner) {
  std::vector<std::uint32_t> order(mesh.indices.size()), source, keys;
  std::iota(order.begin(), order.end(), 0u);
  const auto pairOf = [&](std::uint32_t corner) {
    return std::pair(mesh.indices[corner], key_of_corner[corner]);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return pairOf(a) < pairOf(b); });
  std::vector<std::uint32_t> indices(mesh.indices.size());
  for (const std::uint32_t corner : order) {
    const auto [vertex, key] = pairOf(corner);
    if (source.empty() || source.back() != vertex || keys.back() != key)
      source.push_back(vertex), keys.push_back(key);
    indices[corner] = static_cast<std::uint32_t>(source.size() - 1);
  }
  mesh.indices = std::move(indices);
  remapVertices(mesh, source);
  return keys;
}

}  // namespace

void computeNormals(Mesh& mesh, float crease_rad) {
  const std::size_t faces = mesh.triangleCount();
  std::vector<glm::dvec3> face_normals(faces);
  for (std::size_t f = 0; f < faces; ++f) {
    const std::uint32_t* t = &mesh.indices[3 * f];
    const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    face_normals[f] = length > 0.0 ? normal / length : glm::dvec3(0, 1, 0);
  }
  // Coplanar faces stay together at a crease of 0: a rounding error of a float's position moves a normal by about 1e-5.
  const double least_cos = std::min(std::cos(static_cast<double>(crease_rad)), 1.0 - 1e-9);
  const std::vector<std::uint32_t> weld = weldByPosition(mesh);
  std::vector<std::uint32_t> group = smoothingGroups(mesh, weld, face_normals, least_cos);
  const std::vector<GroupSum> sums = sumGroups(mesh, group, face_normals);
  if (crease_rad > kFlat) joinFolds(mesh, weld, sums, group);

  std::vector<std::uint32_t> keys = splitVertices(mesh, group);
  mesh.normals.resize(mesh.vertexCount());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const glm::dvec3& sum = sums[keys[i]].normal;
    const double length = glm::length(sum);
    mesh.normals[i] = glm::vec3(length > 1e-12 ? sum / length : face_normals[keys[i] / 3]);
  }
}

void computeTangents(Mesh& mesh, const TextureSlot& normal_map) {
  if (static_cast<std::size_t>(normal_map.uv_set) >= mesh.uv_sets.size()) return setAnyTangents(mesh);
  const auto uvAt = [&](std::uint32_t vertex) {
    const glm::vec2 uv = mesh.uv_sets[static_cast<std::size_t>(normal_map.uv_set)][vertex];
    return glm::dvec2(normal_map.texture_from_uv * glm::vec3(uv, 1.0f));
  };
  const auto signedArea = [&](const std::uint32_t* t) {
    const glm::dvec2 d1 = uvAt(t[1]) - uvAt(t[0]), d2 = uvAt(t[2]) - uvAt(t[0]);
    return d1.x * d2.y - d1.y * d2.x;
  };
  std::vector<std::uint32_t> mirrored(mesh.indices.size());
  for (std::size_t i = 0; i < mirrored.size(); ++i)
    mirrored[i] = signedArea(&mesh.indices[i / 3 * 3]) > 0.0 ? 1 : 0;
  const std::vector<std::uint32_t> keys = splitVertices(mesh, mirrored);

  std::vector<glm::dvec3> sums(mesh.vertexCount(), glm::dvec3(0.0));
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const std::uint32_t* t = &mesh.indices[i];
    const double area = signedArea(t);
    if (area == 0.0) continue;
    const glm::dvec3 e1 = glm::dvec3(mesh.positions[t[1]]) - glm::dvec3(mesh.positions[t[0]]);
    const glm::dvec3 e2 = glm::dvec3(mesh.positions[t[2]]) - glm::dvec3(mesh.positions[t[0]]);
    const double dv1 = uvAt(t[1]).y - uvAt(t[0]).y, dv2 = uvAt(t[2]).y - uvAt(t[0]).y;
    const glm::dvec3 du = (e1 * dv2 - e2 * dv1) * (area > 0.0 ? 1.0 : -1.0);
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 n(mesh.normals[t[k]]);
      const glm::dvec3 flat = du - n * glm::dot(n, du);
      const double length = glm::length(flat);
      if (length > 0.0) sums[t[k]] += flat / length * angleAt(mesh, t, k);
    }
  }
  setAnyTangents(mesh);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const double length = glm::length(sums[i]);
    if (length > 1e-9) mesh.tangents[i] = glm::vec4(glm::vec3(sums[i] / length), 1.0f);
    mesh.tangents[i].w = keys[i] ? -1.0f : 1.0f;
  }
}

}  // namespace gloam
