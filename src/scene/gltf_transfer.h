// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// GLOAM_precomputed_transfer, our glTF extension of a primitive: baked transfer in ordinary accessors
// (docs/formats/GLOAM_precomputed_transfer.md).
#pragma once

#include <gloam/scene.h>

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "scene/glb_builder.h"
#include "scene/gltf_accessors.h"

namespace gloam {

inline constexpr const char* kTransferExtension = "GLOAM_precomputed_transfer";

/// CRC-32 (as in zlib and PNG) of a primitive's geometry: all positions as little-endian floats x, y, z, then all indices
/// as little-endian 32-bit numbers. Eight hexadecimal digits.
std::string geometryChecksum(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices);

/// The same of a set of texture coordinates: of all floats u, v.
std::string texCoordChecksum(std::span<const glm::vec2> uvs);

/// What a transfer holds: "unshadowed" (DU, which samples no direction), "shadowed" (DS) or "interreflected" (DI).
const char* transferKind(const Transfer& transfer);

/// The extension's object; its data goes into the builder as accessors. Half floats clamp at 65504.
nlohmann::json transferJson(const Transfer& transfer, const Mesh& mesh, bool half_float, GlbBuilder& builder);

/// A set of texture coordinates of all of the file's vertices; none where the primitive lacks it.
using UvSet = std::function<std::optional<std::vector<glm::vec2>>(int set)>;

/// Reads the extension's object for a primitive with that geometry (all of the file's vertices, triangles' corners as they
/// stand in the file). `where` is the object's JSON path. Throws Error that names the field: a version that is not known, a
/// missing accessor, one of another type or count, a value that is not finite, transfer of another geometry.
std::shared_ptr<const Transfer> readTransfer(GltfAccessors& accessors, const nlohmann::json& extension,
                                             std::span<const glm::vec3> positions,
                                             std::span<const std::uint32_t> indices, const UvSet& uvSet,
                                             const std::string& where);

/// The transfer of some vertices, in that order; texels stay what they are.
std::shared_ptr<const Transfer> transferOfVertices(const Transfer& transfer,
                                                   std::span<const std::uint32_t> vertices);

}  // namespace gloam
