// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gloam::cli {

/// The folder that all of a comparison goes to. It is made when the first file is about to be written, and only its last
/// part: a mistyped path should not grow a tree.
class CompareFolder {
 public:
  /// Throws Error where a file is in its place, or the folder that is to hold it is not there.
  explicit CompareFolder(std::filesystem::path path);
  void make() const;
  std::filesystem::path file(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }
  /// Removes pictures that results.json of an earlier comparison here lists and that are not among `kept`.
  void removeStale(const std::vector<std::filesystem::path>& kept) const;
  /// Whole or not at all.
  void writeText(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

}  // namespace gloam::cli
