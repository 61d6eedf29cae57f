// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The formats that come through assimp: .obj, .ply, .off, .fbx, .3ds.
#pragma once

#include <gloam/scene.h>

#include <filesystem>
#include <string>

namespace gloam {

/// True for the extensions above (lower case, with the dot), also where gloam was built without assimp.
bool assimpReads(const std::string& extension);

/// Reads one of them. Base colour from the diffuse colour, roughness from the Phong exponent (n = 2 / roughness^4 - 2, the
/// same as in shading), metallic 0 unless the file says otherwise, all surfaces double-sided, as these formats tell no
/// sides. Normals that are missing are smooth below a crease of 60 degrees. Pictures that are missing are a warning.
///
/// assimp was written for good files: it runs in a child process (where the system has fork) with limits on time and memory
/// by the file's size, so that no file can crash or hang this one. Throws Error, also where gloam was built without assimp.
Scene readWithAssimp(const std::filesystem::path& path, const Progress& progress);

// ---- Parts, apart for the tests -------------------------------------------------------------------------------------

/// assimp's own reading, in this process. Textures are names of files or encoded bytes (width 0); normals and tangents may
/// be empty; nothing is checked beyond what assimp promises. Throws Error.
Scene importWithAssimp(const std::filesystem::path& path);

/// Runs `work` in a child process and returns the scene that it made. Throws its Error; Error also when it crashed, took
/// longer than `seconds` of CPU time (or 3 s more by the clock) or more memory than `bytes`.
Scene importInChild(const std::filesystem::path& path, double seconds, std::uint64_t bytes,
                    const Progress& progress, Scene (*work)(const std::filesystem::path&));

/// Decodes textures, mends meshes and says what was missing, for a scene from importWithAssimp.
void finishImport(Scene& scene, const std::filesystem::path& path);

}  // namespace gloam
