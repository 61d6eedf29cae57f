// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "compare_folder.h"

#include <fmt/core.h>
#include <gloam/error.h>
#include <image/atomic_file.h>

namespace gloam::cli {

namespace fs = std::filesystem;

CompareFolder::CompareFolder(fs::path path) : path_(std::move(path)) {
  if (!path_.has_filename()) path_ = path_.parent_path();  // "out/"
  std::error_code ignored;
  if (fs::is_directory(path_, ignored)) return;
  if (fs::exists(path_, ignored)) throw Error(path_.string(), "is a file; expected a folder to write to");
  const fs::path above = path_.parent_path();
  if (!above.empty() && !fs::is_directory(above, ignored)) {
    throw Error(path_.string(), fmt::format("there is no folder {}", above.string()));
  }
}

void CompareFolder::make() const {
  std::error_code error;
  if (fs::is_directory(path_, error)) return;
  fs::create_directory(path_, error);
  if (error) throw Error(path_.string(), fmt::format("cannot make this folder: {}", error.message()));
}

void CompareFolder::writeText(const std::string& name, const std::string& text) const {
  AtomicFile out(file(name));
  out.write(text.data(), text.size());
  out.commit();
}

}  // namespace gloam::cli
