// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What assimp takes on trust in .off and .ply files: counts and indices.
#pragma once

#include <filesystem>

namespace gloam {

/// Throws Error(path, ...) where a text .off holds fewer vertices or faces than its header claims, or a face names a vertex
/// that is not there (assimp would draw another one instead). Forms that it does not know are left to assimp.
void checkOffFile(const std::filesystem::path& path);

/// Throws Error(path, ...) where the header of a .ply claims more elements than the file has bytes for.
void checkPlyFile(const std::filesystem::path& path);

}  // namespace gloam
