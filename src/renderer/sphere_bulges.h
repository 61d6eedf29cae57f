// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A few spheres do not follow a thin or flat part of a thing: an ear's stand out of it on both sides by half. What receives on that part
// is not to be darkened by them (spheres/receiver_rule.h).
#pragma once

#include <gloam/spheres.h>

#include <vector>

namespace gloam {

/// For each sphere of a set, drawn in by these shares of radii, the part of its width that stands above the tangent plane of the surface
/// within it, 0 to 1: the median over points of that surface, spread evenly by area; 0 where none lies within. At rest.
std::vector<float> sphereBulges(const Scene& scene, const SphereSet& set, const std::vector<float>& shares);

}  // namespace gloam
