// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// All points share one set of directions, each turned by one of a few dozen rotations: what few directions miss is then noise
// from point to point, which bounces average out, and no edge that runs across walls. Basis functions stay those of the set,
// since a point's sums are turned as a whole: f(R s) and f(s) have coefficients that one rotation leads from one to the other.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "math/sh_high_order.h"

namespace gloam::prt {

struct Turn {
  glm::mat3 matrix{1.0f};         ///< from the axes of the set to the world
  sh::HighRotation coefficients;  ///< the same of functions
};

class Turns {
 public:
  static constexpr std::size_t kCount = 64;
  /// For that many bands; made once. Thread-safe.
  static const Turns& of(int order);
  /// By the place and the normal alone, so that neither the order of points nor that of threads matters.
  const Turn& at(const glm::vec3& position, const glm::vec3& normal) const;

 private:
  explicit Turns(int order);
  std::vector<Turn> turns_;
};

}  // namespace gloam::prt
