// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_tessellate_split.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <unordered_map>

namespace gloam::prt {
namespace {

/// Of two places, either way round.
std::uint64_t edgeKey(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
}

template <class Vector>
void appendMix(std::vector<Vector>& values, std::uint32_t a, std::uint32_t b, float share) {
  if (!values.empty()) values.push_back((1.0f - share) * values[a] + share * values[b]);
}

glm::vec3 unitMix(const glm::vec3& a, const glm::vec3& b, float share) {
  const glm::vec3 sum = (1.0f - share) * a + share * b;
  const float length = glm::length(sum);
  return length > 1.0e-6f ? sum / length : a;
}

/// A vertex on the way from one to another.
std::uint32_t appendBetween(Mesh& mesh, std::uint32_t a, std::uint32_t b, float share) {
  const std::uint32_t index = std::uint32_t(mesh.vertexCount());
  appendMix(mesh.positions, a, b, share);
  if (!mesh.normals.empty()) mesh.normals.push_back(unitMix(mesh.normals[a], mesh.normals[b], share));
  if (!mesh.tangents.empty()) {
    const glm::vec4 t = mesh.tangents[a], u = mesh.tangents[b];
    mesh.tangents.emplace_back(unitMix(glm::vec3(t), glm::vec3(u), share), t.w);
  }
  for (std::vector<glm::vec2>& uvs : mesh.uv_sets) appendMix(uvs, a, b, share);
  appendMix(mesh.colors, a, b, share);
  // Joints of a mesh that stands without a skin move nothing.
  for (int k = 0; k < mesh.influences; ++k) {
    mesh.joints.push_back(mesh.joints[a * std::size_t(mesh.influences) + std::size_t(k)]);
    mesh.weights.push_back(mesh.weights[a * std::size_t(mesh.influences) + std::size_t(k)]);
  }
  return index;
}

}  // namespace

/// Edges of this moment, and which of them are split. Ends are those of the key, the place of the lower number first.
struct SplitMesh::Edges {
  std::unordered_map<std::uint64_t, std::uint32_t> index;  // by key
  std::vector<std::uint32_t> first_triangle;               // [edge + 1], into triangles
  std::vector<TriangleRef> triangles;
  std::vector<std::uint32_t> copies;  // vertices that splitting it makes
  std::vector<std::uint64_t> keys;
  std::vector<double> share;          // where on the way from its first end
  std::vector<std::uint32_t> middle;  // place; kWhole: not split
  static constexpr std::uint32_t kWhole = ~0u;
};

SplitMesh::SplitMesh(Scene& scene, const PosedScene& posed) : scene_(scene) {
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> known;
  for (const Instance& instance : posed.instances) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    const bool taken = !instance.deformed() && !mesh.indices.empty();
    mesh_of_.push_back(taken ? instance.mesh : kNone);
    std::vector<std::uint32_t>& places = place_.emplace_back();
    for (std::size_t v = 0; taken && v < mesh.vertexCount(); ++v) {
      const glm::vec3 p = glm::vec3(instance.world_from_object * glm::vec4(mesh.positions[v], 1.0f)) + 0.0f;
      const std::array<std::uint32_t, 3> key = {std::bit_cast<std::uint32_t>(p.x),
                                                std::bit_cast<std::uint32_t>(p.y),
                                                std::bit_cast<std::uint32_t>(p.z)};
      const auto [found, is_new] = known.try_emplace(key, std::uint32_t(places_.size()));
      if (is_new) places_.emplace_back(p);
      places.push_back(found->second);
    }
  }
}

std::size_t SplitMesh::vertexCount() const {
  std::size_t count = 0;
  for (const std::vector<std::uint32_t>& places : place_) count += places.size();
  return count;
}

std::size_t SplitMesh::triangleCount() const {
  std::size_t count = 0;
  for (const int mesh : mesh_of_)
    count += mesh == kNone ? 0 : scene_.meshes[std::size_t(mesh)].triangleCount();
  return count;
}

// Equal lengths are told apart by their places, so that both sides of an edge agree.
std::uint64_t SplitMesh::longest(std::size_t instance, std::size_t triangle) const {
  const std::uint32_t* corner = &meshOf(instance).indices[3 * triangle];
  double length = -1.0;
  std::uint64_t key = 0;
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t a = place_[instance][corner[k]], b = place_[instance][corner[(k + 1) % 3]];
    const glm::dvec3 way = places_[a] - places_[b];
    const double squared = glm::dot(way, way);
    if (squared < length || (squared == length && edgeKey(a, b) < key)) continue;
    length = squared;
    key = edgeKey(a, b);
  }
  return key;
}

float SplitMesh::longestEdge(const TriangleRef& triangle) const {
  const std::uint64_t key = longest(triangle.instance, triangle.triangle);
  return float(glm::distance(places_[std::size_t(key >> 32)], places_[std::size_t(key & 0xffffffffu)]));
}

double SplitMesh::area(const TriangleRef& triangle) const {
  const std::uint32_t* corner = &meshOf(triangle.instance).indices[3 * std::size_t(triangle.triangle)];
  const auto at = [&](int k) { return places_[place_[triangle.instance][corner[k]]]; };
  return 0.5 * glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
}

// Always from the same end, so that all meshes get the same bits.
std::uint32_t SplitMesh::middle(std::size_t instance, std::uint32_t a, std::uint32_t b, const Edges& edges) {
  const std::uint64_t key = edgeKey(place_[instance][a], place_[instance][b]);
  if (place_[instance][a] > place_[instance][b]) std::swap(a, b);
  const std::uint32_t edge = edges.index.at(key);
  place_[instance].push_back(edges.middle[edge]);
  return appendBetween(meshOf(instance), a, b, float(edges.share[edge]));
}

void SplitMesh::splitMesh(std::size_t instance, const Edges& edges, std::vector<std::uint32_t>& parents) {
  Mesh& mesh = meshOf(instance);
  std::unordered_map<std::uint64_t, std::uint32_t> middles;  // by vertices
  const auto isSplit = [&](std::uint32_t a, std::uint32_t b) {
    const auto found = edges.index.find(edgeKey(place_[instance][a], place_[instance][b]));
    return found != edges.index.end() && edges.middle[found->second] != Edges::kWhole;
  };
  const auto middleOf = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] = middles.try_emplace(edgeKey(a, b), 0u);
    if (is_new) found->second = middle(instance, std::min(a, b), std::max(a, b), edges);
    return found->second;
  };
  std::vector<std::uint32_t> indices;
  const std::size_t count = mesh.triangleCount();
  for (std::size_t t = 0; t < count; ++t) {
    const auto emit = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      indices.insert(indices.end(), {a, b, c});
      parents.push_back(std::uint32_t(t));
    };
    std::uint32_t corner[3] = {mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]};
    const std::uint64_t key = longest(instance, t);
    while (edgeKey(place_[instance][corner[0]], place_[instance][corner[1]]) != key)
      std::rotate(corner, corner + 1, corner + 3);
    for (int k = 0; k < 2 && !isSplit(corner[0], corner[1]); ++k)  // cut, but not there
      std::rotate(corner, corner + 1, corner + 3);
    const auto [a, b, c] = corner;
    if (!isSplit(a, b)) {
      emit(mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]);
      continue;
    }
    const std::uint32_t m = middleOf(a, b);
    if (isSplit(c, a)) {
      const std::uint32_t n = middleOf(c, a);
      emit(a, m, n);
      emit(n, m, c);
    } else {
      emit(a, m, c);
    }
    if (isSplit(b, c)) {
      const std::uint32_t p = middleOf(b, c);
      emit(m, b, p);
      emit(m, p, c);
    } else {
      emit(m, b, c);
    }
  }
  mesh.indices = std::move(indices);
}

SplitMesh::Edges SplitMesh::collectEdges() const {
  Edges edges;
  struct Side {
    std::uint32_t edge;
    TriangleRef triangle;
    std::uint64_t vertices;
  };
  std::vector<Side> sides;
  for (std::uint32_t i = 0; i < mesh_of_.size(); ++i) {
    if (mesh_of_[i] == kNone) continue;
    const Mesh& mesh = meshOf(i);
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t a = mesh.indices[3 * t + k], b = mesh.indices[3 * t + (k + 1) % 3];
        const auto edge =
            edges.index.try_emplace(edgeKey(place_[i][a], place_[i][b]), std::uint32_t(edges.index.size()));
        sides.push_back({edge.first->second, {i, t}, edgeKey(a, b)});
      }
    }
  }
  std::ranges::sort(sides, {}, [](const Side& s) {
    return std::tuple(s.edge, s.triangle.instance, s.vertices, s.triangle.triangle);
  });
  edges.first_triangle.assign(edges.index.size() + 1, 0);
  edges.copies.assign(edges.index.size(), 0);
  edges.middle.assign(edges.index.size(), Edges::kWhole);
  edges.share.assign(edges.index.size(), 0.5);
  edges.keys.resize(edges.index.size());
  for (const auto& [key, edge] : edges.index) edges.keys[edge] = key;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const Side& side = sides[s];
    ++edges.first_triangle[side.edge + 1];
    edges.triangles.push_back(side.triangle);
    const bool same = s > 0 && sides[s - 1].edge == side.edge &&
                      sides[s - 1].triangle.instance == side.triangle.instance &&
                      sides[s - 1].vertices == side.vertices;
    edges.copies[side.edge] += same ? 0 : 1;
  }
  for (std::size_t e = 0; e < edges.copies.size(); ++e)
    edges.first_triangle[e + 1] += edges.first_triangle[e];
  return edges;
}

std::vector<std::uint32_t> SplitMesh::markSplit(const TriangleRef& triangle, Edges& edges,
                                                std::size_t& made) const {
  std::vector<std::uint32_t> marked, open;
  const auto mark = [&](std::uint64_t key) {
    const std::uint32_t edge = edges.index.at(key);
    if (edges.middle[edge] != Edges::kWhole) return;
    edges.middle[edge] = 0;
    made += edges.copies[edge];
    marked.push_back(edge);
    open.push_back(edge);
  };
  mark(longest(triangle.instance, triangle.triangle));
  while (!open.empty()) {
    const std::uint32_t edge = open.back();
    open.pop_back();
    for (std::uint32_t s = edges.first_triangle[edge]; s < edges.first_triangle[edge + 1]; ++s)
      mark(longest(edges.triangles[s].instance, edges.triangles[s].triangle));
  }
  return marked;
}

glm::dvec3 SplitMesh::normalOf(const Edges& edges, std::size_t edge) const {
  glm::dvec3 sum(0.0);
  for (std::uint32_t s = edges.first_triangle[edge]; s < edges.first_triangle[edge + 1]; ++s) {
    const TriangleRef& triangle = edges.triangles[s];
    const std::uint32_t* corner = &meshOf(triangle.instance).indices[3 * std::size_t(triangle.triangle)];
    const auto at = [&](int k) { return places_[place_[triangle.instance][corner[k]]]; };
    const glm::dvec3 across = glm::cross(at(1) - at(0), at(2) - at(0));
    if (const double length = glm::length(across); length > 0.0) sum += across / length;
  }
  const double length = glm::length(sum);
  return length > 1e-3 ? sum / length : glm::dvec3(0.0);
}

std::vector<std::vector<std::uint32_t>> SplitMesh::apply(Edges& edges) {
  for (std::size_t e = 0; e < edges.keys.size(); ++e) {
    if (edges.middle[e] == Edges::kWhole) continue;
    const glm::dvec3 a = places_[std::size_t(edges.keys[e] >> 32)],
                     b = places_[std::size_t(edges.keys[e] & 0xffffffffu)];
    edges.middle[e] = std::uint32_t(places_.size());
    places_.push_back((1.0 - edges.share[e]) * a + edges.share[e] * b);
  }
  std::vector<std::vector<std::uint32_t>> parents(mesh_of_.size());
  for (std::size_t i = 0; i < mesh_of_.size(); ++i) {
    if (mesh_of_[i] != kNone) splitMesh(i, edges, parents[i]);
  }
  return parents;
}

std::vector<std::vector<std::uint32_t>> SplitMesh::cut(const Crossing& crossing, const glm::dvec2& lengths,
                                                       std::size_t max_vertices) {
  Edges edges = collectEdges();
  std::vector<double> shares(edges.keys.size(), 0.0);
  tbb::parallel_for(std::size_t(0), shares.size(), [&](std::size_t e) {
    const glm::dvec3 &a = places_[std::size_t(edges.keys[e] >> 32)],
                     &b = places_[std::size_t(edges.keys[e] & 0xffffffffu)];
    const double length = glm::distance(a, b);
    if (length >= lengths.x && length <= lengths.y) shares[e] = crossing(a, b, normalOf(edges, e));
  });
  std::size_t vertices = vertexCount();
  full_ = false;
  for (std::size_t e = 0; e < shares.size() && !full_; ++e) {
    if (!(shares[e] > 0.0)) continue;
    full_ = vertices + edges.copies[e] > max_vertices;
    if (full_) break;
    vertices += edges.copies[e];
    edges.share[e] = shares[e];
    edges.middle[e] = 0;
  }
  return apply(edges);
}

std::vector<std::vector<std::uint32_t>> SplitMesh::split(const std::vector<TriangleRef>& triangles,
                                                         std::size_t max_vertices) {
  Edges edges = collectEdges();
  std::size_t vertices = vertexCount();
  full_ = false;
  for (const TriangleRef& triangle : triangles) {
    std::size_t made = 0;
    const std::vector<std::uint32_t> marked = markSplit(triangle, edges, made);
    if (vertices + made > max_vertices) {
      for (const std::uint32_t edge : marked) edges.middle[edge] = Edges::kWhole;
      full_ = true;
      break;
    }
    vertices += made;
  }
  return apply(edges);
}

}  // namespace gloam::prt
