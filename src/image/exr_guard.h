// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A look at an EXR file's headers before the library takes memory by what they claim.
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <vector>

namespace gloam {

struct ExrChannel {
  std::string name;
  int type = 0;  ///< 0 UINT, 1 HALF, 2 FLOAT
  int x_sampling = 1, y_sampling = 1;
};

/// Corners, both inside.
struct ExrWindow {
  std::int32_t min_x = 0, min_y = 0, max_x = -1, max_y = -1;
  std::int64_t width() const { return std::int64_t(max_x) - min_x + 1; }
  std::int64_t height() const { return std::int64_t(max_y) - min_y + 1; }
  bool operator==(const ExrWindow&) const = default;
};

struct ExrPart {
  std::string
      type;  ///< "scanlineimage", "tiledimage", "deepscanline", "deeptile" or empty (from the version field)
  std::vector<ExrChannel> channels;
  ExrWindow data, display;
  int compression = -1;
  std::uint32_t tile_width = 0, tile_height = 0;
  bool has_tiles = false;  ///< the attribute stands there
  bool deep = false;
};

// What is kept of a header's string attributes; longer ones and further ones are left out.
inline constexpr std::size_t kMaxStringAttributes = 256, kMaxStringAttributeBytes = 4096;

/// Reads all headers and checks every size in them against the file's length. Throws Error(place, what): not
/// an EXR file, an attribute that is longer than the file, windows, tiles or chunk tables that the file
/// cannot hold.
std::vector<ExrPart> checkExrHeaders(std::istream& stream, std::uint64_t file_bytes,
                                     const std::string& place);

}  // namespace gloam
