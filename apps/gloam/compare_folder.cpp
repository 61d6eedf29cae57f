// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "compare_folder.h"

#include <fmt/core.h>
#include <gloam/error.h>
#include <image/atomic_file.h>

#include <algorithm>
#include <fstream>

#include "json.h"

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

void CompareFolder::removeStale(const std::vector<fs::path>& kept) const {
  std::ifstream stream(file("results.json"));
  const Json before = Json::parse(stream, nullptr, false);
  if (!before.is_object() || !before.contains("techniques") || !before["techniques"].is_array()) return;
  for (const Json& technique : before["techniques"]) {
    for (const char* field : {"file", "reference_file"}) {
      if (!technique.is_object() || !technique.contains(field) || !technique[field].is_string()) continue;
      // Of this folder, and of a name that a comparison gives: whatever a changed results.json says.
      const fs::path name = technique[field].get<std::string>();
      if (name != name.filename() || name.extension() != ".exr" || name == "reference.exr") continue;
      const fs::path old = file(name.string());
      std::error_code ignored;
      const auto same = [&](const fs::path& other) { return fs::equivalent(old, other, ignored); };
      if (std::ranges::any_of(kept, same)) continue;
      if (fs::is_regular_file(fs::symlink_status(old, ignored))) fs::remove(old, ignored);
    }
  }
}

void CompareFolder::writeText(const std::string& name, const std::string& text) const {
  AtomicFile out(file(name));
  out.write(text.data(), text.size());
  out.commit();
}

}  // namespace gloam::cli
