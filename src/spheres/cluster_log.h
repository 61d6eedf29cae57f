// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Log visibility of many spheres from a cluster of receivers, by a cut of their tree (SS-3): far groups count as one sphere, with
// ratio vectors.
#pragma once

#include <gloam/spheres.h>

#include <array>
#include <span>
#include <vector>

#include "math/sh_log_exp.h"

namespace gloam::spheres {

struct CutLimits {
  /// Groups that look no larger than that from a receiver count as one sphere,
  float sin_coarse = 0.4f;
  /// from that on as their children; between, both are blended. More than sin_coarse.
  float sin_fine = 0.6f;
};

/// Log visibility of one sphere from a point, of the table's order; a point inside sees it as one that touches.
sh::Sh logOfSphere(const sh::LogBlockerTable& table, const Sphere& sphere, const glm::vec3& receiver);
/// The sum of that over spheres: what a cut approximates.
sh::Sh logOfSpheres(const sh::LogBlockerTable& table, std::span<const Sphere> spheres,
                    const glm::vec3& receiver);

/// A factor a band that turns the log visibility of a node's bound into that of all its leaves, from one point: of least squares.
using RatioVector = std::array<float, 6>;

/// One cluster's cut. Keeps references to tree, spheres and table.
class ClusterLog {
 public:
  /// `receivers`: a ball that holds the cluster's receivers; ratio vectors are those of its centre. `spheres` are the tree's leaves.
  /// Throws Error for limits out of 0 to 1 or out of order, and where tree and spheres differ in number.
  ClusterLog(const SphereTree& tree, std::span<const Sphere> spheres, const Sphere& receivers,
             const sh::LogBlockerTable& table, const CutLimits& limits = {});

  /// Log visibility from a receiver within the cluster: continuous in its place.
  sh::Sh at(const glm::vec3& receiver) const;
  /// How many spheres at() sums for this receiver.
  std::size_t termsAt(const glm::vec3& receiver) const;

 private:
  /// Of a node's own sphere, against its children's: 1 as far as sin_coarse, 0 from sin_fine.
  float shareOf(const SphereTree::Node& node, const glm::vec3& receiver) const;
  template <typename Add>
  void visit(const glm::vec3& receiver, const Add& add) const;

  const SphereTree& tree_;
  std::span<const Sphere> spheres_;
  const sh::LogBlockerTable& table_;
  CutLimits limits_;
  std::vector<int> ratio_of_;  // of each node: index into ratios_, kNone where none is needed in this cluster
  std::vector<RatioVector> ratios_;
};

}  // namespace gloam::spheres
