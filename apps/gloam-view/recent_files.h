// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace gloam::view {

/// Scenes that were opened, the latest first; kept under $XDG_CONFIG_HOME/gloam/recent.json (~/.config/gloam). A list that
/// cannot be read is an empty one, one that cannot be written is not kept.
class RecentFiles {
 public:
  RecentFiles();
  const std::vector<std::string>& names() const { return names_; }
  void add(const std::string& name);

 private:
  std::vector<std::string> names_;
};

}  // namespace gloam::view
