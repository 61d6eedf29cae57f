// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/scene.h>

#include <string>

namespace gloam {

enum class SceneStage {
  kImported,  ///< textures not decoded, normals, tangents and texture coordinates may be missing, meshes may be empty
  kFinished,
};

/// The promise that a Scene makes to whoever gets it: indices in range, arrays of matching length, a tree of nodes, finite
/// positions, normals and tangents present, at least one triangle shown. Throws Error(place, what is wrong).
void checkScene(const Scene& scene, const std::string& place, SceneStage stage = SceneStage::kFinished);

}  // namespace gloam
