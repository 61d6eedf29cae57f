// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>
#include <limits>

namespace gloam {

/// Bounds along the axes, empty at first: low above high.
struct Box {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{-std::numeric_limits<float>::max()};
  void add(const glm::vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  void add(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  bool empty() const { return low.x > high.x; }
};

}  // namespace gloam
