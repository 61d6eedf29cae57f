// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What preparation and tables share: directions and their Voronoi cells.
#pragma once

#include <gloam/spherical_lights.h>

#include "scene/scene_fingerprint.h"

namespace gloam::spherical_lights {

/// Vertices of an icosahedron, then points of its edges, then of its faces.
std::array<glm::vec3, kEmissionDirections> geodesicDirections();

/// Y_j: integrals of the basis, four bands, over the directions that are nearest to direction j.
const std::array<sh::Sh, kEmissionDirections>& voronoiSums();

std::string emissionFingerprint(const SphereSet& set);

}  // namespace gloam::spherical_lights
