// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "visibility/device_shared.h"

namespace gloam::visibility {

/// A hierarchy of boxes over triangles, four children a node, as the device walks through it.
class BoxTree {
 public:
  /// Built anew on all cores; the same tree for any number of threads. At most 2^29 triangles.
  void build(std::span<const BoxTriangle> triangles);
  /// The same tree over triangles that moved. False where its boxes overlap much more than when it was built: then build().
  bool refit(std::span<const BoxTriangle> triangles);

  const std::vector<BoxNode>& nodes() const {
    return nodes_;
  }  ///< at least one; children stand after parents
  const std::vector<BoxTriangle>& triangles() const { return triangles_; }  ///< in the order of leaves
  /// The most nodes that a tree of so many triangles has.
  static std::size_t mostNodes(std::size_t triangles) { return triangles / 2 + 1; }

 private:
  double fitBoxes();

  std::vector<BoxNode> nodes_;
  std::vector<BoxTriangle> triangles_;
  std::vector<std::uint32_t> order_;  // which triangle stands where
  double built_area_ = 0.0;
};

/// The slow twin of the shader: whether anything stands within t_far.
bool occluded(const BoxTree& tree, const glm::vec3& origin, const glm::vec3& direction, float t_far);

}  // namespace gloam::visibility
