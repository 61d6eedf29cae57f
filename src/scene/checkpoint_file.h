// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Files that keep unfinished work: a header that says whose, the work, a checksum of all of it. Numbers are as the machine
// has them; the header holds a pattern that another byte order would break.
#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>

#include "image/atomic_file.h"
#include "scene/scene_fingerprint.h"

namespace gloam {

/// What a checkpoint must agree in to be taken up again.
struct CheckpointKind {
  char magic[8];          ///< of the kind of work
  std::uint32_t version;  ///< to be raised when the numbers of the work change
  const char* work;       ///< for errors: "a bake"
};

/// Writes beside the target; commit() renames. Throws Error as AtomicFile does.
class CheckpointWriter {
 public:
  CheckpointWriter(const std::filesystem::path& path, const CheckpointKind& kind,
                   const Fingerprint& fingerprint);
  void write(const void* data, std::size_t bytes);
  void commit();
  /// When this process last kept any work; before that, when it began. Work in stages, each with a file of its own, counts
  /// from here, so that no more than one interval of all of it is ever at stake.
  static std::chrono::steady_clock::time_point lastCommit();

 private:
  AtomicFile file_;
  Fingerprint sum_;
};

/// Reads in the order of writing. Throws Error where the file cannot be read, is something else, belongs to other work or
/// another version, or is damaged: it might be dear to someone, so it is neither used nor overwritten.
class CheckpointReader {
 public:
  CheckpointReader(const std::filesystem::path& path, const CheckpointKind& kind,
                   const Fingerprint& fingerprint);
  void read(void* data, std::size_t bytes);
  /// After the last read: nothing is believed before this has returned.
  void finish();
  /// "FILE: is a damaged checkpoint (what); delete it or name another checkpoint".
  [[noreturn]] void damaged(const char* what) const;

 private:
  [[noreturn]] void refuse(const std::string& what) const;
  const std::filesystem::path path_;
  std::ifstream in_;
  Fingerprint sum_;
};

}  // namespace gloam
