// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Shapes from flat and parametric patches; shapes that turn about an axis are in builtin_shapes_round.cpp.
#include "scene/builtin_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/mesh_repair.h"
#include "scene/transforms.h"

namespace gloam::shapes {
namespace {

bool hasArea(const Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const glm::vec3 ab = mesh.positions[b] - mesh.positions[a], ac = mesh.positions[c] - mesh.positions[a];
  const float longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(ab - ac, ab - ac)});
  return glm::length(glm::cross(ab, ac)) > 1e-6f * longest;
}

void addTriangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (hasArea(mesh, a, b, c)) mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

// Rows of nu + 1 vertices, v down: counter-clockwise from outside.
void addGridTriangles(Mesh& mesh, std::uint32_t first, int nu, int nv) {
  const std::uint32_t row = std::uint32_t(nu) + 1;
  for (std::uint32_t j = 0; j < std::uint32_t(nv); ++j) {
    for (std::uint32_t i = 0; i < std::uint32_t(nu); ++i) {
      const std::uint32_t a = first + j * row + i, b = a + 1, c = a + row, d = c + 1;
      addTriangle(mesh, a, c, d);
      addTriangle(mesh, a, d, b);
    }
  }
}

void addVertex(Mesh& mesh, const glm::vec3& position, const glm::vec3& normal, const glm::vec3& tangent,
               const glm::vec2& uv) {
  const glm::vec3 n = glm::normalize(normal);
  const glm::vec3 t = tangent - n * glm::dot(n, tangent);
  mesh.positions.push_back(position);
  mesh.normals.push_back(n);
  mesh.tangents.emplace_back(glm::normalize(t), 1.0f);
  mesh.uv_sets[0].push_back(uv);
}

Mesh emptyMesh() {
  Mesh mesh;
  mesh.uv_sets.resize(1);
  return mesh;
}

int cells(float length, float cell) {
  return std::max(1, int(std::ceil(length / cell - 1e-4f)));
}

// The six sides of a box: outward normal, direction of u; v runs down or towards the back.
struct Side {
  glm::vec3 normal, u, v;
};
constexpr std::array<Side, 6> kSides = {{{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                         {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},
                                         {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                         {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}},
                                         {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                         {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}}};

// Coordinates along one axis: bevel cells in the rounded part at each end, cells of the given size between.
std::vector<float> bevelledLines(float half, float radius, float cell, int bevel) {
  std::vector<float> lines;
  const float inner = half - radius;
  for (int i = 0; i < bevel; ++i) {
    // Equal angles on the rounded edge: the face covers 45 degrees of it.
    const float angle_rad = 0.785398163f * (1.0f - float(i) / float(bevel));
    lines.push_back(-inner - radius * std::tan(angle_rad));
  }
  const int n = inner > 0.0f ? cells(2.0f * inner, cell) : 0;
  for (int i = 0; i <= n; ++i) lines.push_back(n > 0 ? -inner + 2.0f * inner * float(i) / float(n) : 0.0f);
  const std::size_t mirrored = std::size_t(bevel);
  for (std::size_t i = mirrored; i-- > 0;) lines.push_back(-lines[i]);
  return lines;
}

void addRoundedSide(Mesh& mesh, const Side& side, const glm::vec3& half, float radius, float cell,
                    int bevel) {
  const float half_u = std::abs(glm::dot(half, side.u)), half_v = std::abs(glm::dot(half, side.v));
  const float depth = std::abs(glm::dot(half, side.normal));
  const std::vector<float> us = bevelledLines(half_u, radius, cell, bevel);
  const std::vector<float> vs = bevelledLines(half_v, radius, cell, bevel);
  const std::uint32_t first = std::uint32_t(mesh.vertexCount());
  for (const float v : vs) {
    for (const float u : us) {
      const glm::vec3 p = side.normal * depth + side.u * u + side.v * v;
      const glm::vec3 core = glm::clamp(p, -(half - radius), half - radius);
      const glm::vec3 normal = glm::normalize(p - core);
      addVertex(mesh, core + radius * normal, normal, side.u,
                {0.5f + 0.5f * u / half_u, 0.5f + 0.5f * v / half_v});
    }
  }
  addGridTriangles(mesh, first, int(us.size()) - 1, int(vs.size()) - 1);
}

}  // namespace

Mesh surface(int nu, int nv, const std::function<SurfacePoint(float u, float v)>& point) {
  Mesh mesh = emptyMesh();
  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) {
      const glm::vec2 uv(float(i) / float(nu), float(j) / float(nv));
      const SurfacePoint p = point(uv.x, uv.y);
      addVertex(mesh, p.position, p.normal, p.tangent, uv);
    }
  }
  addGridTriangles(mesh, 0, nu, nv);
  removeUnusedVertices(mesh);  // the last one of a row at a pole
  return mesh;
}

std::vector<float> steps(int n) {
  std::vector<float> values;
  for (int i = 0; i <= n; ++i) values.push_back(float(i) / float(n));
  return values;
}

std::vector<float> spaced(float length, float cell, float overlap_start, float overlap_end) {
  constexpr float kCornerGap_m = 0.003f;
  std::vector<float> values;
  const float first = overlap_start > 0.0f ? kCornerGap_m : 0.0f;
  const float last = length - (overlap_end > 0.0f ? kCornerGap_m : 0.0f);
  const int n = cells(last - first, cell);
  if (overlap_start > 0.0f) values.push_back(-overlap_start);
  for (int i = 0; i <= n; ++i) values.push_back(first + (last - first) * float(i) / float(n));
  if (overlap_end > 0.0f) values.push_back(length + overlap_end);
  return values;
}

Mesh patch(const glm::vec3& origin, const glm::vec3& edge_u, const glm::vec3& edge_v,
           const std::vector<float>& us, const std::vector<float>& vs) {
  Mesh mesh = emptyMesh();
  const glm::vec3 normal = glm::cross(edge_v, edge_u);
  for (const float v : vs) {
    for (const float u : us) addVertex(mesh, origin + u * edge_u + v * edge_v, normal, edge_u, {u, v});
  }
  addGridTriangles(mesh, 0, int(us.size()) - 1, int(vs.size()) - 1);
  return mesh;
}

Mesh ground(float size_x, float size_z, int nx, int nz) {
  return patch({-0.5f * size_x, 0.0f, -0.5f * size_z}, {size_x, 0, 0}, {0, 0, size_z}, steps(nx), steps(nz));
}

Mesh extrude(const std::vector<glm::vec2>& profile, const std::vector<float>& xs) {
  Mesh mesh = emptyMesh();
  float length = 0.0f;
  const std::size_t last = profile.size() - 1;
  for (std::size_t j = 0; j <= last; ++j) {
    const glm::vec2 along = profile[std::min(j + 1, last)] - profile[j > 0 ? j - 1 : 0];
    if (j > 0) length += glm::length(profile[j] - profile[j - 1]);
    for (const float x : xs) {
      addVertex(mesh, {x, profile[j].y, profile[j].x}, {0.0f, along.x, -along.y}, {1, 0, 0}, {x, length});
    }
  }
  addGridTriangles(mesh, 0, int(xs.size()) - 1, int(last));
  return mesh;
}

Mesh box(const glm::vec3& low, const glm::vec3& high, float cell) {
  Mesh mesh = emptyMesh();
  const glm::vec3 centre = 0.5f * (low + high), half = 0.5f * (high - low);
  for (const Side& side : kSides) {
    const glm::vec3 u = side.u * glm::abs(half), v = side.v * glm::abs(half);
    append(mesh, patch(centre + side.normal * half - u - v, 2.0f * u, 2.0f * v,
                       steps(cells(2.0f * glm::length(u), cell)), steps(cells(2.0f * glm::length(v), cell))));
  }
  return mesh;
}

Mesh roundedBox(const glm::vec3& half, float radius, float cell, int bevel) {
  Mesh mesh = emptyMesh();
  for (const Side& side : kSides) addRoundedSide(mesh, side, half, radius, cell, bevel);
  return mesh;
}

Mesh slab(float half_x, float half_z, float thickness, float radius, float cell) {
  Mesh mesh = emptyMesh();
  const glm::vec3 half(half_x, 0.5f * thickness, half_z);
  for (const Side& side : kSides) {
    if (side.normal.y > -0.5f) addRoundedSide(mesh, side, half, radius, cell, 3);
  }
  return moved(std::move(mesh), {0.0f, -0.5f * thickness, 0.0f});
}

Mesh transformed(Mesh mesh, const glm::mat4& matrix) {
  const glm::mat3 linear(matrix), for_normals = normalTransform(linear);
  const bool mirrored = glm::determinant(linear) < 0.0f;
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    mesh.positions[i] = glm::vec3(matrix * glm::vec4(mesh.positions[i], 1.0f));
    mesh.normals[i] = glm::normalize(for_normals * mesh.normals[i]);
    glm::vec3 tangent = linear * glm::vec3(mesh.tangents[i]);
    tangent -= mesh.normals[i] * glm::dot(mesh.normals[i], tangent);
    mesh.tangents[i] =
        glm::vec4(glm::normalize(tangent), mirrored ? -mesh.tangents[i].w : mesh.tangents[i].w);
  }
  if (mirrored) {
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
      std::swap(mesh.indices[t + 1], mesh.indices[t + 2]);
  }
  return mesh;
}

Mesh moved(Mesh mesh, const glm::vec3& by) {
  for (glm::vec3& p : mesh.positions) p += by;
  return mesh;
}

void append(Mesh& mesh, const Mesh& other) {
  const std::uint32_t first = std::uint32_t(mesh.vertexCount());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
  mesh.tangents.insert(mesh.tangents.end(), other.tangents.begin(), other.tangents.end());
  mesh.uv_sets.resize(1);
  mesh.uv_sets[0].insert(mesh.uv_sets[0].end(), other.uv_sets[0].begin(), other.uv_sets[0].end());
  for (const std::uint32_t i : other.indices) mesh.indices.push_back(first + i);
}

Mesh withUvScale(Mesh mesh, const glm::vec2& scale) {
  for (glm::vec2& uv : mesh.uv_sets[0]) uv *= scale;
  return mesh;
}

void makeTangents(Mesh& mesh) {
  mesh.tangents.resize(mesh.vertexCount());
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) {
    const glm::vec3& n = mesh.normals[i];
    // To the right for whoever looks at the surface with +Y up.
    const glm::vec3 side = std::abs(n.y) < 0.999f ? glm::cross({0, 1, 0}, n) : glm::cross({0, 0, -1}, n);
    mesh.tangents[i] = glm::vec4(glm::normalize(side), 1.0f);
  }
}

}  // namespace gloam::shapes
