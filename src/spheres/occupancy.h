// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How much of space a solid fills: the quick answer to "what volume of this ball lies outside it?".
#pragma once

#include <functional>

#include "spheres/winding.h"

namespace gloam::spheres {

struct Ball {
  glm::vec3 center{0.0f};
  float radius = 0.0f;
};

inline float ballVolume(float radius) {
  return 4.18879020f * radius * radius * radius;
}

/// Cells of a grid with the share of each that is inside the solid, kept as sums along x.
class Occupancy {
 public:
  /// `cells` along the longest side. `closed`: no edge is open, so that cells away from the surface are alike in whole blocks.
  /// `shell`: the surface itself is what is solid, one cell thick (sheets that enclose nothing).
  Occupancy(const Soup& soup, const WindingTree& winding, int cells, bool closed, bool shell,
            const std::function<bool()>& should_stop = {});

  /// Volume of the ball outside the solid, by chords through rows of cells: 0.5 % of the ball's volume at a radius of 8 cells.
  float outsideVolume(const glm::vec3& center, float radius) const;
  float volume() const { return volume_; }
  float cell() const { return cell_; }
  /// Middles of the cells that are solid throughout.
  std::vector<glm::vec3> fullCells() const;

 private:
  float share(const glm::ivec3& at) const { return shares_[index(at)]; }
  std::size_t index(const glm::ivec3& at) const {
    return (std::size_t(at.z) * std::size_t(size_.y) + std::size_t(at.y)) * std::size_t(size_.x) +
           std::size_t(at.x);
  }
  void markSurface(const Soup& soup, std::vector<std::uint8_t>& surface) const;
  void markTriangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, std::vector<std::uint8_t>& surface) const;
  void fillBlock(const glm::ivec3& block, const WindingTree& winding,
                 const std::vector<std::uint8_t>& surface, bool whole_blocks);
  float sampledShare(const glm::ivec3& at, const WindingTree& winding) const;
  void sumRows();
  /// Length outside the solid from the grid's lower end to x (in cells; may be negative or beyond the end) in one row.
  float outsideBefore(const float* row, float x) const;

  glm::ivec3 size_{0};
  glm::vec3 low_{0.0f};
  float cell_ = 1.0f, volume_ = 0.0f;
  std::vector<float> shares_;          ///< inside share, 0 to 1
  std::vector<float> outside_before_;  ///< [z][y][x of size.x + 1]
};

}  // namespace gloam::spheres
