// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// GLOAM_neighbourhood_transfer, our glTF extension of a node: baked neighbourhood transfer in ordinary accessors
// (docs/formats/GLOAM_neighbourhood_transfer.md).
#pragma once

#include <gloam/neighbourhood.h>

#include <nlohmann/json.hpp>

#include "scene/glb_builder.h"
#include "scene/gltf_accessors.h"

namespace gloam {

inline constexpr const char* kNeighbourhoodExtension = "GLOAM_neighbourhood_transfer";

/// The extension's object; its data goes into the builder as accessors. Half floats clamp at 65504.
nlohmann::json neighbourhoodJson(const NeighbourhoodTransfer& transfer, bool half_float, GlbBuilder& builder);

/// Hangs them on the builder's nodes, which stand in the scene's order.
void writeNeighbourhoods(const Scene& scene, bool half_float, GlbBuilder& builder);

/// Reads the extension's object. `where` is its JSON path. Throws Error that names the field: a version that is not known, a
/// missing member or accessor, one of another type or count, a value that is not finite, a grid too large for memory.
std::shared_ptr<const NeighbourhoodTransfer> readNeighbourhood(GltfAccessors& accessors,
                                                               const nlohmann::json& extension,
                                                               const std::string& where);

}  // namespace gloam
