// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Lightmap texels to points: conservative coverage, gutters from the nearest (two sweeps over vectors to the nearest,
// Danielsson 1980, "Euclidean distance mapping").
#include "techniques/prt/prt_bake_texels.h"

#include <algorithm>
#include <cmath>

namespace gloam::prt {
namespace {

float cross2(const glm::vec2& a, const glm::vec2& b) {
  return a.x * b.y - a.y * b.x;
}

struct Nearest {
  glm::vec2 share{0.0f};
  float squared = std::numeric_limits<float>::max();
};

/// Of an edge from one barycentric place to another.
void nearestOnEdge(const glm::vec2& p, const glm::vec2& from, const glm::vec2& to,
                   const glm::vec2& share_from, const glm::vec2& share_to, Nearest& nearest) {
  const glm::vec2 way = to - from;
  const float length = glm::dot(way, way);
  const float t = length > 0.0f ? std::clamp(glm::dot(p - from, way) / length, 0.0f, 1.0f) : 0.0f;
  const glm::vec2 off = from + t * way - p;
  const float squared = glm::dot(off, off);
  if (squared < nearest.squared) nearest = {glm::mix(share_from, share_to, t), squared};
}

Nearest nearestInTriangle(const glm::vec2& p, const glm::vec2 (&corner)[3]) {
  const float area = cross2(corner[1] - corner[0], corner[2] - corner[0]);
  const glm::vec2 share(cross2(p - corner[0], corner[2] - corner[0]) / area,
                        cross2(corner[1] - corner[0], p - corner[0]) / area);
  if (share.x >= 0.0f && share.y >= 0.0f && share.x + share.y <= 1.0f) return {share, 0.0f};
  Nearest nearest;
  nearestOnEdge(p, corner[0], corner[1], {0, 0}, {1, 0}, nearest);
  nearestOnEdge(p, corner[1], corner[2], {1, 0}, {0, 1}, nearest);
  nearestOnEdge(p, corner[2], corner[0], {0, 1}, {0, 0}, nearest);
  return nearest;
}

/// Corners in texels, whole numbers at texels' corners.
void texelCorners(const Mesh& mesh, const LightmapSize& size, std::size_t triangle, glm::vec2 (&corner)[3]) {
  const std::vector<glm::vec2>& uvs = mesh.uv_sets[std::size_t(size.uv_set)];
  for (std::size_t k = 0; k < 3; ++k)
    corner[k] = glm::clamp(uvs[mesh.indices[3 * triangle + k]], 0.0f, 1.0f) *
                glm::vec2(float(size.width), float(size.height));
}

/// For each texel without a point that of the nearest one with: sweeps that hand on where the nearest lies.
void fillGutters(TexelMap& map) {
  const int width = map.width, height = map.height;
  std::vector<glm::i16vec2> nearest(map.points.size(), glm::i16vec2(-1));
  const auto index = [&](int x, int y) { return std::size_t(y) * std::size_t(width) + std::size_t(x); };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (map.points[index(x, y)] != BakePoints::kNoPoint) nearest[index(x, y)] = glm::i16vec2(x, y);
    }
  }
  const auto squared = [&](const glm::i16vec2& from, int x, int y) {
    const long long dx = from.x - x, dy = from.y - y;
    return from.x < 0 ? std::numeric_limits<long long>::max() : dx * dx + dy * dy;
  };
  const auto take = [&](int x, int y, int other_x, int other_y) {
    if (other_x < 0 || other_x >= width || other_y < 0 || other_y >= height) return;
    const glm::i16vec2 candidate = nearest[index(other_x, other_y)];
    if (squared(candidate, x, y) < squared(nearest[index(x, y)], x, y)) nearest[index(x, y)] = candidate;
  };
  const auto sweepRow = [&](int y, int before) {
    for (int x = 0; x < width; ++x) {
      for (int dx = -1; dx <= 1; ++dx) take(x, y, x + dx, y + before);
      take(x, y, x - 1, y);
    }
    for (int x = width - 1; x >= 0; --x) take(x, y, x + 1, y);
  };
  for (int y = 0; y < height; ++y) sweepRow(y, -1);
  for (int y = height - 1; y >= 0; --y) sweepRow(y, 1);
  std::vector<std::uint32_t> filled(map.points.size());
  for (std::size_t t = 0; t < filled.size(); ++t) filled[t] = map.points[index(nearest[t].x, nearest[t].y)];
  map.points = std::move(filled);
}

}  // namespace

std::vector<CoveredTexel> coveredTexels(const Mesh& mesh, const LightmapSize& size) {
  const std::size_t count = std::size_t(size.width) * std::size_t(size.height);
  std::vector<CoveredTexel> texels(count);
  std::vector<float> squared(count, 0.5f + 1.0e-4f);  // of half a texel's diagonal
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    glm::vec2 corner[3];
    texelCorners(mesh, size, t, corner);
    if (cross2(corner[1] - corner[0], corner[2] - corner[0]) == 0.0f) continue;
    const glm::vec2 low = glm::min(corner[0], glm::min(corner[1], corner[2])) - 1.25f;
    const glm::vec2 high = glm::max(corner[0], glm::max(corner[1], corner[2])) + 0.25f;
    const int x_end = std::min(int(std::ceil(high.x)), size.width - 1);
    const int y_end = std::min(int(std::ceil(high.y)), size.height - 1);
    for (int y = std::max(int(std::floor(low.y)), 0); y <= y_end; ++y) {
      for (int x = std::max(int(std::floor(low.x)), 0); x <= x_end; ++x) {
        const std::size_t texel = std::size_t(y) * std::size_t(size.width) + std::size_t(x);
        const Nearest nearest = nearestInTriangle(glm::vec2(float(x), float(y)) + 0.5f, corner);
        if (!(nearest.squared < squared[texel])) continue;
        squared[texel] = nearest.squared;
        texels[texel] = {std::uint32_t(t), nearest.share};
      }
    }
  }
  return texels;
}

void addTexels(BakePoints& points, const Scene& scene, const PosedScene& posed,
               const std::vector<LightmapSize>& sizes) {
  if (sizes.empty()) return;
  points.texel_maps.resize(posed.instances.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (sizes[i].width == 0) continue;
    const Mesh& mesh = scene.meshes[std::size_t(posed.instances[i].mesh)];
    const std::vector<CoveredTexel> covered = coveredTexels(mesh, sizes[i]);
    TexelMap& map = points.texel_maps[i];
    map = {sizes[i].width, sizes[i].height, sizes[i].uv_set, {}};
    map.points.assign(covered.size(), BakePoints::kNoPoint);
    for (std::size_t t = 0; t < covered.size(); ++t) {
      if (covered[t].triangle == CoveredTexel::kNoTriangle) continue;
      glm::vec2 corner[3];
      texelCorners(mesh, sizes[i], covered[t].triangle, corner);
      const std::uint32_t triangle = points.first_triangle[i] + covered[t].triangle;
      const glm::uvec3& at = points.triangles[triangle];
      const glm::vec3 &a = points.positions[at.x], &b = points.positions[at.y], &c = points.positions[at.z];
      const float in_world = glm::length(glm::cross(b - a, c - a));
      const float in_texels = std::abs(cross2(corner[1] - corner[0], corner[2] - corner[0]));
      map.points[t] = std::uint32_t(points.size());
      addFacePoint(points, {triangle, covered[t].share, std::sqrt(in_world / in_texels), std::uint32_t(i),
                            std::uint32_t(t)});
    }
    const bool covers =
        std::ranges::any_of(map.points, [](std::uint32_t point) { return point != BakePoints::kNoPoint; });
    if (covers) {
      fillGutters(map);
    } else {
      map = {};
    }
  }
}

std::uint32_t texelBeside(const BakePoints& points, std::size_t point, int dx, int dy) {
  constexpr float kFarthest = 3.0f, kLeastCos = 0.5f;  // farther, or round an edge: another part of the mesh
  const FacePoint& own = points.facePoint(point);
  if (own.instance == ~0u) return BakePoints::kNoPoint;
  const TexelMap& map = points.texel_maps[own.instance];
  const int x = int(own.texel % std::uint32_t(map.width)) + dx,
            y = int(own.texel / std::uint32_t(map.width)) + dy;
  if (x < 0 || y < 0 || x >= map.width || y >= map.height) return BakePoints::kNoPoint;
  const std::uint32_t texel = std::uint32_t(y) * std::uint32_t(map.width) + std::uint32_t(x);
  const std::uint32_t q = map.points[texel];
  const FacePoint& other = points.facePoint(q);
  const float reach = kFarthest * std::max(own.spacing, other.spacing);
  const bool beside = other.texel == texel &&
                      glm::distance(points.positions[q], points.positions[point]) < reach &&
                      glm::dot(points.normals[q], points.normals[point]) > kLeastCos;
  return beside ? q : BakePoints::kNoPoint;
}

TexelCorners texelsAt(const TexelMap& map, const Mesh& mesh, int triangle, float u, float v) {
  const std::vector<glm::vec2>& uvs = mesh.uv_sets[std::size_t(map.uv_set)];
  const std::uint32_t* corner = &mesh.indices[3 * std::size_t(triangle)];
  const glm::vec2 uv = (1.0f - u - v) * uvs[corner[0]] + u * uvs[corner[1]] + v * uvs[corner[2]];
  const glm::vec2 last(float(map.width - 1), float(map.height - 1));
  const glm::vec2 place =
      glm::clamp(uv * glm::vec2(float(map.width), float(map.height)) - 0.5f, glm::vec2(0.0f), last);
  const glm::vec2 cell = glm::min(glm::floor(place), glm::max(last - 1.0f, glm::vec2(0.0f)));
  const glm::vec2 f = place - cell;
  const std::size_t first = std::size_t(cell.y) * std::size_t(map.width) + std::size_t(cell.x);
  const std::size_t right = map.width > 1 ? 1 : 0, below = map.height > 1 ? std::size_t(map.width) : 0;
  const std::uint32_t x = map.points[first + right], y = map.points[first + below];
  if (f.x + f.y <= 1.0f) return {{map.points[first], x, y}, {1.0f - f.x - f.y, f.x, f.y}};
  return {{map.points[first + right + below], y, x}, {f.x + f.y - 1.0f, 1.0f - f.x, 1.0f - f.y}};
}

}  // namespace gloam::prt
