// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Spheres round a receiver, made by chance but the same for the same seed: what exponentials are fitted to and measured
// on; and what is truly visible behind them.
#pragma once

#include <vector>

#include "math/sh_log_exp.h"

namespace gloam::sh {

/// A sphere as the receiver sees it.
struct Blocker {
  glm::vec3 direction;
  float half_angle_rad;
};

/// kScattered: spheres of radius 0.08 to 0.58, centres 0.5 to 4 away in the upper half (+Z), every second set 0.3 to
/// 1.5 away. kBody: one overlapping chain of spheres of similar sizes, as sphere sets of a figure are. The receiver is
/// in none of them.
enum class Arrangement { kScattered, kBody };

std::vector<std::vector<Blocker>> randomBlockers(Arrangement arrangement, int blockers, int sets,
                                                 std::uint32_t seed);

/// Sum of the blockers' logs.
Sh sumOfLogs(const LogBlockerTable& table, const std::vector<Blocker>& blockers);
/// The blockers' visibilities multiplied one after the other, without logs.
Sh productOfVisibilities(int order, const std::vector<Blocker>& blockers);

/// Quadrature over the sphere with the basis ready: `rings` Gauss-Legendre rings of 2 rings points each.
class SphereGrid {
 public:
  explicit SphereGrid(int rings);
  /// Projection of what is visible: 1 where no blocker is, else 0.
  Sh projectVisibility(int order, const std::vector<Blocker>& blockers) const;
  /// Projection of exp(f(s)), taken direction by direction.
  Sh projectExponential(const Sh& f) const;

 private:
  std::vector<glm::vec3> directions_;
  std::vector<float> weights_;
  std::vector<float> basis_;  ///< 36 a direction
};

}  // namespace gloam::sh
