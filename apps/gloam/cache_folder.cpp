// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "cache_folder.h"

#include <cstdlib>

namespace gloam::cli {

namespace fs = std::filesystem;

std::optional<fs::path> cacheFolder(const std::string& kind) {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder;
  if (cache != nullptr && fs::path(cache).is_absolute()) {
    folder = cache;
  } else if (home != nullptr && *home != '\0') {
    folder = fs::path(home) / ".cache";
  } else {
    return std::nullopt;
  }
  folder = folder / "gloam" / kind;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return std::nullopt;
  return folder;
}

}  // namespace gloam::cli
