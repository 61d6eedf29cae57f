// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The points of a scene at which transfer is computed, and where exactly the rays of each start.
#pragma once

#include <gloam/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gloam::prt {

/// A point that lies on a face, no vertex: a texel's middle.
struct FacePoint {
  std::uint32_t triangle = 0;    ///< into BakePoints::triangles
  glm::vec2 share{0.0f};         ///< barycentric, of the second and third corner
  float spacing = 0.0f;          ///< metres to the next such point
  std::uint32_t instance = ~0u;  ///< whose lightmap it belongs to; ~0: none's
  std::uint32_t texel = 0;       ///< of that lightmap: y * width + x
};

/// The lightmap of an instance.
struct TexelMap {
  int width = 0, height = 0, uv_set = 0;  ///< width 0: its transfer is that of vertices
  std::vector<std::uint32_t> points;  ///< [texel]: its own point, or that of the nearest texel that has one
};

/// Vertices of all rigid instances in world space. Vertices at one place with one normal (split along seams of texture
/// coordinates, materials or meshes) are one point: no seam can show, and it is computed once.
struct BakePoints {
  static constexpr std::uint32_t kNoPoint = ~0u;

  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< unit shading normals: whose cosine and horizon count

  std::vector<std::uint32_t> first_vertex;     ///< [instance], into point_of_vertex
  std::vector<std::uint32_t> point_of_vertex;  ///< kNoPoint for vertices that no triangle uses
  std::vector<std::uint32_t> first_triangle;   ///< [instance], into triangles
  std::vector<glm::uvec3> triangles;           ///< points of each triangle of the instances that are taken
  /// Normal of each triangle as its vertices' shading normals have it: +1 where they agree with the winding
  /// (Hit::geometric_normal), -1 where they oppose it.
  std::vector<std::int8_t> facing;

  std::vector<std::uint32_t> first_face;  ///< [point + 1], into faces
  std::vector<std::uint32_t> faces;       ///< triangles around each point

  std::vector<FacePoint> on_faces;   ///< of the last points
  std::vector<TexelMap> texel_maps;  ///< [instance]; empty where there are no texels at all
  bool onFace(std::size_t point) const { return point + on_faces.size() >= size(); }
  const FacePoint& facePoint(std::size_t point) const { return on_faces[point + on_faces.size() - size()]; }
  /// Whether what is sent on from an instance is that of its texels.
  bool hasTexels(std::size_t instance) const { return !texel_maps.empty() && texel_maps[instance].width > 0; }

  std::size_t size() const { return positions.size(); }
  std::span<const std::uint32_t> facesOf(std::size_t point) const {
    return {faces.data() + first_face[point], faces.data() + first_face[point + 1]};
  }
  glm::vec3 centroid(std::uint32_t triangle) const {
    const glm::uvec3& t = triangles[triangle];
    return (positions[t.x] + positions[t.y] + positions[t.z]) / 3.0f;
  }
};

/// Skinned and morphed instances are left out.
BakePoints makeBakePoints(const Scene& scene, const PosedScene& posed);

/// Adds a point on a face, behind all vertices. Its normal is interpolated.
void addFacePoint(BakePoints& points, const FacePoint& point);

/// Where the rays of a point start. A vertex is the worst place of its surface: walls meet there, and rays from it run
/// inside other walls. So the origin is moved
/// - along the surface, by kInset of the way towards the mean of the centroids of the faces around it (what meets a
///   wall's edge is then seen from the wall, not from inside the edge);
/// - up along the shading normal until it stands at least `lift` above the planes of all these faces (convex ones fall
///   away from it, concave ones rise and must not cover it), `lift` being kLift of the mean way to the centroids, and
///   never less than the surface offset (trace/rays.h) of these faces.
/// At a convex vertex no direction above the shading horizon is then blocked by the faces around it, at any tessellation.
/// On a face the origin stands off the triangle's edges by kFaceInset of the spacing, and on the smooth surface that its
/// vertices' normals describe where that lies above the triangle (Hanika 2021, "Hacking the shadow terminator").
glm::vec3 rayOrigin(const BakePoints& points, std::size_t point);

/// The same for a place that lies `share` of the way from the vertex to the centroid of one of its faces: where else to
/// look from when the vertex itself is inside something.
glm::vec3 rayOriginOnFace(const BakePoints& points, std::size_t point, std::uint32_t face, float share);

/// trace::surfaceOffset, the greatest of the faces around a point.
float surfaceOffset(const BakePoints& points, std::size_t point);
/// Mean way from a point to the centroids of the faces around it; on a face, FacePoint::spacing.
float meshSpacing(const BakePoints& points, std::size_t point);

inline constexpr float kInset = 0.01f;
inline constexpr float kLift = 0.001f;
inline constexpr float kFaceInset = 0.01f;

}  // namespace gloam::prt
