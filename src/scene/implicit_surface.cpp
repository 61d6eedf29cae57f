// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Surface nets (Gibson 1998, "Constrained elastic surface nets"): a vertex at the mean of the crossings on a cell's edges, a
// quad for each grid edge that crosses the surface; vertices are then drawn onto the surface along the gradient.
#include "scene/implicit_surface.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "scene/builtin_shapes.h"

namespace gloam {
namespace {

using Distance = std::function<float(const glm::vec3&)>;

struct Grid {
  glm::vec3 low;
  float cell;
  glm::ivec3 corners;  // in each direction
  std::vector<float> value;

  std::size_t index(const glm::ivec3& c) const {
    return (std::size_t(c.z) * std::size_t(corners.y) + std::size_t(c.y)) * std::size_t(corners.x) +
           std::size_t(c.x);
  }
  glm::vec3 position(const glm::ivec3& c) const { return low + cell * glm::vec3(c); }
  float at(const glm::ivec3& c) const { return value[index(c)]; }
};

glm::vec3 gradient(const Distance& distance, const glm::vec3& p, float h) {
  const glm::vec3 dx(h, 0, 0), dy(0, h, 0), dz(0, 0, h);
  return glm::vec3(distance(p + dx) - distance(p - dx), distance(p + dy) - distance(p - dy),
                   distance(p + dz) - distance(p - dz)) /
         (2.0f * h);
}

/// Mean of the crossings on a cell's twelve edges; false where there are none.
bool cellVertex(const Grid& grid, const glm::ivec3& c, glm::vec3& vertex) {
  glm::vec3 sum(0.0f);
  int crossings = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 4; ++k) {
      glm::ivec3 a = c;
      a[(axis + 1) % 3] += k & 1;
      a[(axis + 2) % 3] += k >> 1;
      glm::ivec3 b = a;
      b[axis] += 1;
      const float va = grid.at(a), vb = grid.at(b);
      if ((va < 0.0f) == (vb < 0.0f)) continue;
      sum += glm::mix(grid.position(a), grid.position(b), va / (va - vb));
      ++crossings;
    }
  }
  if (crossings > 0) vertex = sum / float(crossings);
  return crossings > 0;
}

/// A face of the grid whose corners alternate would join four quads at one edge. The corner nearest to the surface changes
/// sides there. Returns how many did.
int mendAlternatingFaces(Grid& grid) {
  int mended = 0;
  for (int z = 0; z + 1 < grid.corners.z; ++z) {
    for (int y = 0; y + 1 < grid.corners.y; ++y) {
      for (int x = 0; x + 1 < grid.corners.x; ++x) {
        for (int axis = 0; axis < 3; ++axis) {
          glm::ivec3 u(0), v(0);
          u[(axis + 1) % 3] = 1;
          v[(axis + 2) % 3] = 1;
          const glm::ivec3 c(x, y, z);
          float* corner[4] = {&grid.value[grid.index(c)], &grid.value[grid.index(c + u)],
                              &grid.value[grid.index(c + u + v)], &grid.value[grid.index(c + v)]};
          const bool side = *corner[0] < 0.0f;
          if ((*corner[1] < 0.0f) == side || (*corner[2] < 0.0f) != side || (*corner[3] < 0.0f) == side)
            continue;
          float* nearest = corner[0];
          for (float* other : corner) nearest = std::abs(*other) < std::abs(*nearest) ? other : nearest;
          *nearest = *nearest < 0.0f ? 1e-6f * grid.cell : -1e-6f * grid.cell;
          ++mended;
        }
      }
    }
  }
  return mended;
}

void addQuad(Mesh& mesh, const std::uint32_t (&q)[4]) {
  const auto& p = mesh.positions;
  if (glm::length(p[q[0]] - p[q[2]]) < glm::length(p[q[1]] - p[q[3]])) {
    mesh.indices.insert(mesh.indices.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
  } else {
    mesh.indices.insert(mesh.indices.end(), {q[0], q[1], q[3], q[1], q[2], q[3]});
  }
}

}  // namespace

Mesh meshOfSurface(const Distance& distance, const glm::vec3& low, const glm::vec3& high, float cell) {
  Grid grid{low, cell, glm::ivec3(glm::ceil((high - low) / cell)) + 1, {}};
  grid.value.resize(std::size_t(grid.corners.x) * std::size_t(grid.corners.y) * std::size_t(grid.corners.z));
  tbb::parallel_for(0, grid.corners.z, [&](int z) {
    for (int y = 0; y < grid.corners.y; ++y) {
      for (int x = 0; x < grid.corners.x; ++x)
        grid.value[grid.index({x, y, z})] = distance(grid.position({x, y, z}));
    }
  });

  for (int pass = 0; pass < 16 && mendAlternatingFaces(grid) > 0; ++pass) {
  }

  Mesh mesh;
  std::vector<std::uint32_t> vertex_of(grid.value.size(), ~0u);
  for (int z = 0; z + 1 < grid.corners.z; ++z) {
    for (int y = 0; y + 1 < grid.corners.y; ++y) {
      for (int x = 0; x + 1 < grid.corners.x; ++x) {
        glm::vec3 vertex;
        if (!cellVertex(grid, {x, y, z}, vertex)) continue;
        vertex_of[grid.index({x, y, z})] = std::uint32_t(mesh.vertexCount());
        mesh.positions.push_back(vertex);
      }
    }
  }
  mesh.normals.resize(mesh.vertexCount());
  tbb::parallel_for(std::size_t(0), mesh.vertexCount(), [&](std::size_t i) {
    glm::vec3& p = mesh.positions[i];
    // Within its own cell, with a margin: no two vertices meet and no triangle turns over.
    const glm::vec3 corner = low + cell * glm::floor((p - low) / cell);
    for (int step = 0; step < 3; ++step) {
      const glm::vec3 g = gradient(distance, p, 0.1f * cell);
      p -= g * (distance(p) / glm::max(0.25f, glm::dot(g, g)));
    }
    p = glm::clamp(p, corner + 0.12f * cell, corner + 0.88f * cell);
    mesh.normals[i] = glm::normalize(gradient(distance, p, 0.25f * cell));
  });

  // The four cells round an edge, in turn; the quad faces the end that is outside.
  for (int z = 1; z + 1 < grid.corners.z; ++z) {
    for (int y = 1; y + 1 < grid.corners.y; ++y) {
      for (int x = 1; x + 1 < grid.corners.x; ++x) {
        const glm::ivec3 c(x, y, z);
        for (int axis = 0; axis < 3; ++axis) {
          glm::ivec3 end = c, u(0), v(0);
          end[axis] += 1;
          u[(axis + 1) % 3] = 1;
          v[(axis + 2) % 3] = 1;
          const bool inside = grid.at(c) < 0.0f;
          if (inside == (grid.at(end) < 0.0f)) continue;
          const std::uint32_t ring[4] = {vertex_of[grid.index(c - u - v)], vertex_of[grid.index(c - v)],
                                         vertex_of[grid.index(c)], vertex_of[grid.index(c - u)]};
          const std::uint32_t turned[4] = {ring[3], ring[2], ring[1], ring[0]};
          addQuad(mesh, inside ? ring : turned);
        }
      }
    }
  }
  mesh.uv_sets.resize(1);
  for (const glm::vec3& p : mesh.positions) mesh.uv_sets[0].emplace_back(p.x, -p.y);
  shapes::makeTangents(mesh);
  return mesh;
}

}  // namespace gloam
