// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/scene.h>

#include <functional>

namespace gloam {

/// A closed mesh of the set where `distance` is negative, with one vertex in each cell of the grid that the surface
/// crosses. `distance` should grow by about 1 a metre near the surface and be positive on the sides of the box. Normals
/// are its gradient; UVs are (x, -y) in metres.
Mesh meshOfSurface(const std::function<float(const glm::vec3&)>& distance, const glm::vec3& low,
                   const glm::vec3& high, float cell);

}  // namespace gloam
