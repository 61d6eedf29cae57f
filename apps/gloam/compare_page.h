// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The page of `gloam compare`: one file of HTML with pictures, measures, style and script inside (page/).
#pragma once

#include <gloam/image.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "json.h"

namespace gloam::cli {

struct PagePicture {
  std::string label;
  int technique = -1;  ///< index into results["techniques"]; -1: a reference
  int reference = -1;  ///< index of the picture that it is measured against; -1: a reference
  /// R, G, B; empty where there is no such light.
  Image direct, indirect;
  /// By layer ("sum", "direct", "indirect"): error 0 to 1, one channel.
  std::map<std::string, Image> flip;
};

struct Page {
  std::string title;
  Json results;
  std::vector<PagePicture> pictures;  ///< all of one size
  Image coverage;                     ///< one channel: alpha of all pictures
  float exposure_stops = 0.0f;        ///< to begin with
};

/// Pictures above about two million pixels are shown smaller, by a whole factor. Throws Error where the file cannot be
/// written.
void writePage(const Page& page, const std::filesystem::path& path);

}  // namespace gloam::cli
