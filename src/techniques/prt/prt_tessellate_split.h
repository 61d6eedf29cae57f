// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Splitting triangles without cracks: Rivara 1984, "Algorithms for refining triangular grids suitable for adaptive and
// multigrid techniques". Edges are split, not triangles: whoever has the edge is split with it.
#pragma once

#include <gloam/scene.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace gloam::prt {

/// A triangle of a rigid mesh.
struct TriangleRef {
  std::uint32_t instance = 0, triangle = 0;
};

/// The rigid meshes of a scene with unique instances, as places and edges between them. Vertices that stand at one place of
/// the world share it, whatever their mesh, normal or texture coordinates; the middle of an edge is one place for all.
class SplitMesh {
 public:
  SplitMesh(Scene& scene, const PosedScene& posed);

  std::size_t vertexCount() const;    ///< of rigid meshes
  std::size_t triangleCount() const;  ///< of rigid meshes
  /// Of a triangle, in metres.
  float longestEdge(const TriangleRef& triangle) const;
  double area(const TriangleRef& triangle) const;  ///< in square metres
  /// Splits the longest edges of these, the first ones first, and what other triangles need to stay whole: wherever an edge of
  /// a triangle is split, its longest one is, too, so that no slivers come about. Stops before there are more than
  /// `max_vertices`. Returns by instance, for each triangle that now is, the one that it is a part of.
  std::vector<std::vector<std::uint32_t>> split(const std::vector<TriangleRef>& triangles,
                                                std::size_t max_vertices);
  /// The share of the way from a to b, in the world, at which an edge is to be cut; 0: not at all. `normal` is that of the
  /// triangles at the edge, in the mean, or 0. Called by all threads.
  using Crossing = std::function<double(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& normal)>;
  /// Cuts edges of these lengths where `crossing` says, longest or not, and all triangles that have them. Returns as split().
  std::vector<std::vector<std::uint32_t>> cut(const Crossing& crossing, const glm::dvec2& lengths,
                                              std::size_t max_vertices);
  /// Whether the last split() or cut() had to leave any out.
  bool full() const { return full_; }

 private:
  struct Edges;
  Edges collectEdges() const;
  /// Marks the longest edge of a triangle, and all that have to be split with it. Returns those that were not marked before;
  /// adds the vertices that they make.
  std::vector<std::uint32_t> markSplit(const TriangleRef& triangle, Edges& edges, std::size_t& made) const;
  glm::dvec3 normalOf(const Edges& edges, std::size_t edge) const;
  /// Places the new vertices and makes the triangles.
  std::vector<std::vector<std::uint32_t>> apply(Edges& edges);
  std::uint64_t longest(std::size_t instance, std::size_t triangle) const;
  void splitMesh(std::size_t instance, const Edges& edges, std::vector<std::uint32_t>& parents);
  std::uint32_t middle(std::size_t instance, std::uint32_t a, std::uint32_t b, const Edges& edges);

  Mesh& meshOf(std::size_t instance) { return scene_.meshes[std::size_t(mesh_of_[instance])]; }
  const Mesh& meshOf(std::size_t instance) const { return scene_.meshes[std::size_t(mesh_of_[instance])]; }

  Scene& scene_;
  std::vector<int> mesh_of_;                       // [instance]; kNone: deforms, or has no triangles
  std::vector<glm::dvec3> places_;                 // in the world
  std::vector<std::vector<std::uint32_t>> place_;  // [instance][vertex]
  bool full_ = false;
};

}  // namespace gloam::prt
