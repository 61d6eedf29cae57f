// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Spheres of a set bound their object (SS-1), so they are larger than it from every side and shadow too much. Here they are drawn
// in until, from the mean of all sides, they hide as much as the object does.
#pragma once

#include <gloam/spheres.h>

#include <vector>

namespace gloam {

/// For each sphere of a set the part of its radius, up to 1, with which it blocks as much light as what it stands for: first
/// its disc has the mean projected area (over all directions) of the part of the object within it; then all are scaled alike until
/// their union has that of the object. At rest; empty where the object only receives.
std::vector<float> shadowShares(const Scene& scene, const SphereSet& set);

}  // namespace gloam
