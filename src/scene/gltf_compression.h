// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// EXT_meshopt_compression (libmeshoptimizer) and KHR_draco_mesh_compression (libdraco).
#pragma once

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "scene/gltf_accessors.h"

namespace gloam {

/// Throws Error unless the extension obeys the rules of its specification.
void checkMeshoptView(const GltfDocument& document, const nlohmann::json& view, const nlohmann::json& meshopt,
                      const std::string& where);
/// The decompressed view. Throws Error where the data is corrupt.
Bytes decodeMeshopt(GltfDocument& document, ByteSpan compressed, const nlohmann::json& meshopt,
                    const std::string& where);

/// What Draco unpacked: indices, and attributes by name in the layout of their accessors.
struct DracoPrimitive {
  std::vector<std::uint32_t> indices;
  std::map<std::string, AccessorView> attributes;
  std::deque<Bytes> storage;
};
/// Throws Error where the data is corrupt or does not agree with the accessors.
DracoPrimitive decodeDraco(GltfDocument& document, const gloam_tinygltf::Primitive& primitive,
                           const nlohmann::json& draco, const std::string& where);

}  // namespace gloam
