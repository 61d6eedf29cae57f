// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Files beside a bake's output that keep what is finished, whatever stage the bake is in, until the output is written.
#pragma once

#include <filesystem>
#include <functional>

namespace gloam::cli {

class BakeCheckpoints {
 public:
  explicit BakeCheckpoints(const std::filesystem::path& output);

  const std::filesystem::path& transfer() const { return transfer_; }
  /// Of all volumes that are finished.
  std::filesystem::path volumes() const { return transfer_.string() + ".volumes"; }
  /// Of the grid round the n-th object.
  std::filesystem::path neighbourhood(std::size_t n) const;
  void remove() const;

  /// Does the work; errors of these files and interruptions are told in words of the command line. Throws as `work` does.
  void guard(const std::function<void()>& work) const;

 private:
  /// One that is there, or nothing.
  std::filesystem::path any() const;
  std::filesystem::path transfer_;
};

}  // namespace gloam::cli
