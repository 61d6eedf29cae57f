// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Meshes that are no manifold: what a bake says of them, and `gloam bake` refuses unless told not to.
#pragma once

#include <gloam/bake.h>

namespace gloam::prt {

/// Edges that more than two triangles share, vertices at one place taken as one.
std::size_t crowdedEdges(const Mesh& mesh);

/// Which rigid meshes have any, and how many; empty where none has.
std::string crowdedEdgesText(const Scene& scene, const PosedScene& posed);

/// One line of them, where there are such.
void warnOfCrowdedEdges(const Scene& scene, const PosedScene& posed, Warnings& warnings);

}  // namespace gloam::prt
