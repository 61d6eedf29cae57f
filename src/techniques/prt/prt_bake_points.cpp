// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_bake_points.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "scene/transforms.h"
#include "trace/rays.h"

namespace gloam::prt {
namespace {

using PointKey = std::array<std::uint32_t, 6>;

struct PointKeyHash {
  std::size_t operator()(const PointKey& key) const {
    std::uint64_t h = 0x9e3779b97f4a7c15ull;
    for (const std::uint32_t word : key) {
      h = (h ^ word) * 0xff51afd7ed558ccdull;
      h ^= h >> 32;
    }
    return std::size_t(h);
  }
};

// Adding 0 makes one of the two zeros.
PointKey keyOf(const glm::vec3& position, const glm::vec3& normal) {
  const glm::vec3 p = position + 0.0f, n = normal + 0.0f;
  return {std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
          std::bit_cast<std::uint32_t>(p.z), std::bit_cast<std::uint32_t>(n.x),
          std::bit_cast<std::uint32_t>(n.y), std::bit_cast<std::uint32_t>(n.z)};
}

glm::vec3 unitOr(const glm::vec3& v, const glm::vec3& otherwise) {
  const float length = glm::length(v);
  return std::isfinite(length) && length > 1.0e-20f ? v / length : otherwise;
}

class PointBuilder {
 public:
  explicit PointBuilder(BakePoints& points) : points_(points) {}

  void add(const Mesh& mesh, const Instance& instance) {
    const glm::mat3 normal_matrix = normalTransform(glm::mat3(instance.world_from_object));
    const std::size_t first = points_.point_of_vertex.size();
    points_.point_of_vertex.resize(first + mesh.vertexCount(), BakePoints::kNoPoint);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      glm::uvec3 triangle;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t vertex = mesh.indices[i + std::size_t(k)];
        std::uint32_t& point = points_.point_of_vertex[first + vertex];
        if (point == BakePoints::kNoPoint) {
          const glm::vec3 position(instance.world_from_object * glm::vec4(mesh.positions[vertex], 1.0f));
          const glm::vec3 normal =
              mesh.normals.empty() ? glm::vec3(0.0f, 1.0f, 0.0f) : normal_matrix * mesh.normals[vertex];
          point = pointAt(position, unitOr(normal, glm::vec3(0.0f, 1.0f, 0.0f)));
        }
        triangle[k] = point;
      }
      points_.triangles.push_back(triangle);
      points_.facing.push_back(facing(triangle, instance));
    }
  }

 private:
  std::uint32_t pointAt(const glm::vec3& position, const glm::vec3& normal) {
    const auto [found, is_new] =
        index_.try_emplace(keyOf(position, normal), static_cast<std::uint32_t>(points_.positions.size()));
    if (is_new) {
      points_.positions.push_back(position);
      points_.normals.push_back(normal);
    }
    return found->second;
  }

  std::int8_t facing(const glm::uvec3& t, const Instance& instance) const {
    const auto& p = points_.positions;
    const auto& n = points_.normals;
    glm::vec3 winding = glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]);
    if (glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f) winding = -winding;
    return glm::dot(winding, n[t.x] + n[t.y] + n[t.z]) < 0.0f ? -1 : 1;
  }

  BakePoints& points_;
  std::unordered_map<PointKey, std::uint32_t, PointKeyHash> index_;
};

void collectFaces(BakePoints& points) {
  points.first_face.assign(points.size() + 1, 0);
  const auto forCorners = [&](const auto& visit) {
    for (std::size_t t = 0; t < points.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) visit(points.triangles[t][k], static_cast<std::uint32_t>(t));
    }
  };
  forCorners([&](std::uint32_t point, std::uint32_t) { ++points.first_face[point + 1]; });
  for (std::size_t p = 0; p < points.size(); ++p) points.first_face[p + 1] += points.first_face[p];
  points.faces.resize(points.first_face.back());
  std::vector<std::uint32_t> next(points.first_face.begin(), points.first_face.end() - 1);
  forCorners([&](std::uint32_t point, std::uint32_t face) { points.faces[next[point]++] = face; });
}

// Unit normal of a face, on the side of the point's shading normal.
glm::vec3 faceNormal(const BakePoints& points, std::uint32_t face, const glm::vec3& normal) {
  const glm::uvec3& t = points.triangles[face];
  const glm::vec3& a = points.positions[t.x];
  const glm::vec3 n = unitOr(glm::cross(points.positions[t.y] - a, points.positions[t.z] - a), normal);
  return glm::dot(n, normal) < 0.0f ? -n : n;
}

// The place p + along, raised along the normal until it clears all faces around the point.
glm::vec3 raised(const BakePoints& points, std::size_t point, const glm::vec3& along) {
  const glm::vec3& p = points.positions[point];
  const glm::vec3& n = points.normals[point];
  const auto faces = points.facesOf(point);
  const float lift = std::max(surfaceOffset(points, point), kLift * meshSpacing(points, point));
  float height = lift;
  for (const std::uint32_t face : faces) {
    const glm::vec3 normal = faceNormal(points, face, n);
    // A face that stands nearly upright on the tangent plane would ask for a tower; a tenth is the slope that counts.
    const float slope = std::max(0.1f, glm::dot(normal, n));
    height = std::max(height, (lift - glm::dot(along, normal)) / slope);
  }
  return p + along + height * n;
}

glm::vec3 mixed(const std::vector<glm::vec3>& values, const glm::uvec3& corners, const glm::vec2& share) {
  return (1.0f - share.x - share.y) * values[corners.x] + share.x * values[corners.y] +
         share.y * values[corners.z];
}

// Towards the middle of the triangle until all edges are farther than the inset, or half of the way.
glm::vec2 insetShare(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec2& share,
                     float inset) {
  const float doubled = glm::length(glm::cross(b - a, c - a));
  const float edge[3] = {glm::length(c - b), glm::length(c - a), glm::length(b - a)};
  const float at[3] = {1.0f - share.x - share.y, share.x, share.y};
  float towards = 0.0f;
  for (int k = 0; k < 3; ++k) {
    const float least = doubled > 0.0f ? std::min(inset * edge[k] / doubled, 1.0f / 6.0f) : 0.0f;
    if (at[k] < least) towards = std::max(towards, (least - at[k]) / (1.0f / 3.0f - at[k]));
  }
  return glm::mix(share, glm::vec2(1.0f / 3.0f), towards);
}

glm::vec3 rayOriginInFace(const BakePoints& points, std::size_t point) {
  const FacePoint& face = points.facePoint(point);
  const glm::uvec3& corners = points.triangles[face.triangle];
  const auto& p = points.positions;
  const glm::vec2 share =
      insetShare(p[corners.x], p[corners.y], p[corners.z], face.share, kFaceInset * face.spacing);
  const glm::vec3 flat = mixed(p, corners, share);
  const float weights[3] = {1.0f - share.x - share.y, share.x, share.y};
  glm::vec3 origin = flat;
  for (int k = 0; k < 3; ++k) {
    const glm::vec3& normal = points.normals[corners[k]];
    origin += weights[k] * std::max(0.0f, -glm::dot(flat - p[corners[k]], normal)) * normal;
  }
  return origin + std::max(surfaceOffset(points, point), kLift * face.spacing) * points.normals[point];
}

glm::vec3 tangential(const glm::vec3& v, const glm::vec3& normal) {
  return v - normal * glm::dot(v, normal);
}

}  // namespace

BakePoints makeBakePoints(const Scene& scene, const PosedScene& posed) {
  BakePoints points;
  PointBuilder builder(points);
  for (const Instance& instance : posed.instances) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    points.first_vertex.push_back(static_cast<std::uint32_t>(points.point_of_vertex.size()));
    points.first_triangle.push_back(static_cast<std::uint32_t>(points.triangles.size()));
    if (!instance.deformed()) builder.add(mesh, instance);
  }
  collectFaces(points);
  return points;
}

void addFacePoint(BakePoints& points, const FacePoint& point) {
  const glm::uvec3& corners = points.triangles[point.triangle];
  const glm::vec3 normal = mixed(points.normals, corners, point.share);
  points.positions.push_back(mixed(points.positions, corners, point.share));
  points.normals.push_back(unitOr(normal, points.normals[corners.x]));
  points.faces.push_back(point.triangle);
  points.first_face.push_back(static_cast<std::uint32_t>(points.faces.size()));
  points.on_faces.push_back(point);
}

float surfaceOffset(const BakePoints& points, std::size_t point) {
  float offset = 0.0f;
  for (const std::uint32_t face : points.facesOf(point)) {
    const glm::uvec3& t = points.triangles[face];
    offset = std::max(
        offset, trace::surfaceOffset(points.positions[t.x], points.positions[t.y], points.positions[t.z]));
  }
  return offset;
}

float meshSpacing(const BakePoints& points, std::size_t point) {
  if (points.onFace(point)) return points.facePoint(point).spacing;
  float sum = 0.0f;
  const auto faces = points.facesOf(point);
  for (const std::uint32_t face : faces) sum += glm::length(points.centroid(face) - points.positions[point]);
  return sum / float(faces.size());
}

glm::vec3 rayOrigin(const BakePoints& points, std::size_t point) {
  if (points.onFace(point)) return rayOriginInFace(points, point);
  const auto faces = points.facesOf(point);
  glm::vec3 mean(0.0f);
  for (const std::uint32_t face : faces) mean += points.centroid(face) - points.positions[point];
  mean /= float(faces.size());  // every point is some triangle's corner
  return raised(points, point, tangential(mean, points.normals[point]) * kInset);
}

glm::vec3 rayOriginOnFace(const BakePoints& points, std::size_t point, std::uint32_t face, float share) {
  const glm::vec3 way = points.centroid(face) - points.positions[point];
  return raised(points, point, tangential(way, points.normals[point]) * share);
}

}  // namespace gloam::prt
