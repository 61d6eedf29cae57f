// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Vertices that move: morph targets and skins.
#pragma once

#include <gloam/scene.h>

#include <span>

namespace gloam {

/// Adds the weighted morph targets, then moves every vertex into the world: by `world_from_mesh` of each of
/// its joints, or where that is empty by `world_from_object`. Normals go by the inverse transpose of the
/// blended matrix, tangents with the surface and stay perpendicular to them. Fills instance.deformed_*; runs
/// on all cores.
void deformMesh(const Mesh& mesh, std::span<const float> morph_weights,
                std::span<const glm::mat4> world_from_mesh, const glm::mat4& world_from_object,
                Instance& instance);

}  // namespace gloam
