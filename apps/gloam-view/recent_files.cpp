// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "recent_files.h"

#include <gloam/error.h>
#include <image/atomic_file.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "json.h"

namespace gloam::view {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMost = 12, kMaxBytes = 1 << 16;

fs::path listFile() {
  const char* config = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  if (config != nullptr && fs::path(config).is_absolute()) return fs::path(config) / "gloam" / "recent.json";
  if (home != nullptr && *home != '\0') return fs::path(home) / ".config" / "gloam" / "recent.json";
  return {};
}

}  // namespace

RecentFiles::RecentFiles() {
  std::ifstream in(listFile(), std::ios::binary);
  std::string text(kMaxBytes, '\0');
  in.read(text.data(), std::streamsize(text.size()));
  text.resize(std::size_t(in.gcount()));
  const cli::Json json = cli::Json::parse(text, nullptr, false);
  if (!json.is_array()) return;
  for (const auto& name : json) {
    if (name.is_string() && names_.size() < kMost) names_.push_back(name.get<std::string>());
  }
}

void RecentFiles::add(const std::string& name) {
  const bool built_in = name.starts_with("builtin:");
  std::error_code ignored;
  const std::string full = built_in ? name : fs::absolute(name, ignored).string();
  std::erase(names_, full);
  names_.insert(names_.begin(), full);
  if (names_.size() > kMost) names_.resize(kMost);
  const fs::path file = listFile();
  if (file.empty()) return;
  fs::create_directories(file.parent_path(), ignored);
  const std::string text = cli::jsonText(cli::Json(names_)) + "\n";
  try {
    AtomicFile out(file);
    out.write(text.data(), text.size());
    out.commit();
  } catch (const Error&) {  // a home that cannot be written keeps nothing
  }
}

}  // namespace gloam::view
