// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace gloam {

/// Writes beside the target and renames on commit(). Whatever happens before that leaves the target as it was
/// and nothing beside it. A target that is a device or a pipe (/dev/null, /dev/stdout) is written directly; a
/// symbolic link is followed, so that the file behind it is replaced. Errors name the target as it was given.
class AtomicFile {
 public:
  /// Throws Error where the target is a folder, its folder is missing or not writable.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ofstream& stream() { return stream_; }
  /// Where the bytes go until commit(): for programs that write the file themselves.
  const std::filesystem::path& temporaryPath() const { return temporary_; }
  void write(const void* bytes, std::size_t size);
  /// Flushes, closes, renames. Throws Error where any of it failed (disk full).
  void commit();

 private:
  [[noreturn]] void fail(int error_number) const;

  std::filesystem::path target_, resolved_, temporary_;
  std::ofstream stream_;
  bool direct_ = false, committed_ = false;
};

}  // namespace gloam
