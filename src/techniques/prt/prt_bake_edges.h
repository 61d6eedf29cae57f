// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Meshes that are no manifold: what a bake says of them.
#pragma once

#include <gloam/bake.h>

namespace gloam::prt {

/// Edges that more than two triangles share, vertices at one place taken as one.
std::size_t crowdedEdges(const Mesh& mesh);

/// One line of all meshes that have any, where there are such.
void warnOfCrowdedEdges(const Scene& scene, const PosedScene& posed, Warnings& warnings);

}  // namespace gloam::prt
