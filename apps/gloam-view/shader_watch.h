// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Shaders of the rooms, compiled anew when their sources change: who edits one sees it in the next picture.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace gloam::gpu {
struct ShaderCode;
}

namespace gloam::view {

class ShaderWatch {
 public:
  /// `folder` is the src/ of a source tree; empty: nothing is watched. Throws Error where it is none.
  explicit ShaderWatch(std::filesystem::path folder);

  /// Shaders in use of which a source, or a file that it includes, is newer than at the call before. Cheap: reads times of files.
  std::vector<const gpu::ShaderCode*> changed();
  /// Compiles as the build does and hands the words to the device's programs. Throws Error with the compiler's first line.
  static void reload(const std::filesystem::path& folder, const gpu::ShaderCode& code);

  const std::filesystem::path& folder() const { return folder_; }

 private:
  const std::set<std::filesystem::path>& filesOf(const gpu::ShaderCode& code);

  std::filesystem::path folder_;
  std::map<const gpu::ShaderCode*, std::set<std::filesystem::path>>
      files_;  ///< each source with all it includes
  std::map<std::filesystem::path, std::filesystem::file_time_type> times_;
};

}  // namespace gloam::view
