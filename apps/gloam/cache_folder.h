// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace gloam::cli {

/// Where work of that kind ("bakes", "spheres") is kept: $XDG_CACHE_HOME/gloam/KIND, ~/.cache/gloam/KIND. Nothing where there
/// is no home or it cannot be written.
std::optional<std::filesystem::path> cacheFolder(const std::string& kind);

}  // namespace gloam::cli
