// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Where the light around an object is sampled (PRT-5).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace gloam::prt {

/// Points spread over surfaces, each standing for the same area.
struct SurfacePoints {
  std::vector<glm::vec3> positions, normals;
};

/// Adds triangles (three indices each) of one mesh, placed by a matrix; `count` points in all come of what is added.
class SurfaceSampler {
 public:
  void add(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
           std::span<const std::uint32_t> indices, const glm::mat4& placed);
  /// The same for the same triangles; fewer where there is no area.
  SurfacePoints points(int count) const;

 private:
  struct Triangle {
    glm::vec3 corner[3], normal;
    double area_until;
  };
  std::vector<Triangle> triangles_;
  double area_ = 0.0;
};

/// `count` points (1 or more) at which to sample the light around a surface. One: the middle, moved outward; nothing of the
/// object itself is seen from there. More: each stands in front of a part of the surface, a twentieth of its extent away,
/// parts being equal in spread (k-means, seeded by farthest points). The same for the same surface.
std::vector<glm::vec3> pickPoints(const SurfacePoints& surface, int count);

}  // namespace gloam::prt
