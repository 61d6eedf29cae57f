// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// GLOAM_volume, our glTF extension of a node: density and its transfer in ordinary accessors (docs/formats/GLOAM_volume.md).
#pragma once

#include <gloam/volume.h>

#include <nlohmann/json.hpp>

#include "scene/glb_builder.h"
#include "scene/gltf_accessors.h"

namespace gloam {

inline constexpr const char* kVolumeExtension = "GLOAM_volume";

/// Hangs volumes on the builder's nodes, which stand in the scene's order. Half floats clamp at 65504.
void writeVolumes(const Scene& scene, bool half_float, GlbBuilder& builder);

/// Reads the extension's object. `where` is its JSON path. Throws Error that names the field: a version that is not known, a
/// missing member or accessor, one of another type or count, a value that is not finite or out of range, a grid too large.
std::shared_ptr<const Volume> readVolume(GltfAccessors& accessors, const nlohmann::json& extension,
                                         const std::string& where);

}  // namespace gloam
