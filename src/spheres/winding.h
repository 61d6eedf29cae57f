// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How often a surface winds round a point.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace gloam::spheres {

/// Triangles by themselves: what spheres are fitted to.
struct Soup {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;  ///< three a triangle
  std::size_t triangleCount() const { return indices.size() / 3; }
  glm::vec3 corner(std::size_t triangle, int k) const {
    return positions[indices[3 * triangle + std::size_t(k)]];
  }
};

/// Generalised winding numbers: 1 inside a closed surface whose triangles are counter-clockwise seen from outside, 0 outside it,
/// between where the surface is open. Distant triangles count as one dipole, with an error of a few hundredths.
class WindingTree {
 public:
  explicit WindingTree(const Soup& soup);
  float at(const glm::vec3& point) const;
  /// Inside or not, whichever way the surface faces.
  bool inside(const glm::vec3& point) const { return std::abs(at(point)) > 0.5f; }

 private:
  struct Node {
    glm::vec3 center;  ///< area-weighted
    float radius2 =
        0.0f;  ///< of a ball about it that holds the triangles, times the opening distance, squared
    glm::vec3 area_vector;               ///< sum of area times normal
    std::uint32_t first = 0, count = 0;  ///< triangles of a leaf; else count is 0 and `first` the right child
  };
  struct Triangle {
    glm::vec3 a, b, c;
  };
  std::uint32_t build(const Soup& soup, std::vector<std::uint32_t>& order, std::uint32_t begin,
                      std::uint32_t end, const std::vector<glm::vec3>& centers);
  void summarise(Node& node, std::uint32_t begin, std::uint32_t end) const;

  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
};

/// Solid angle of a triangle seen from a point, with the sign of its facing, in steradians (Van Oosterom, Strackee 1983).
float triangleSolidAngle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& point);

}  // namespace gloam::spheres
