// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "file_names.h"

#include <fmt/core.h>

#include <filesystem>

namespace gloam::view {

std::string freeName(const std::string& wanted) {
  const std::filesystem::path path(wanted);
  std::filesystem::path free = path;
  std::error_code ignored;
  for (int number = 2; std::filesystem::exists(free, ignored); ++number)
    free =
        path.parent_path() / fmt::format("{}_{}{}", path.stem().string(), number, path.extension().string());
  return free.string();
}

std::string wholeName(const std::string& name) {
  if (name.empty() || name == "none" || name.starts_with("builtin:") || name.starts_with("sky:")) return name;
  return std::filesystem::absolute(name).lexically_normal().string();
}

}  // namespace gloam::view
