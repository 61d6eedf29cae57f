// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/scene.h>

#include <filesystem>

namespace gloam {

/// Reads a .gltf or .glb, whatever it is called. Normals that a file lacks are flat, as glTF asks. Throws Error that names
/// the file and the field.
Scene readGltf(const std::filesystem::path& path, const Progress& progress);

}  // namespace gloam
