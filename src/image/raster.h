// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PNG and JPEG as they are stored, through libpng and libjpeg: both take damaged files without harm, which the packaged
// stb_image does not (its JPEG decoder writes past a table).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace gloam {

/// Rows from the top, 1 to 4 interleaved channels (Y; Y, A; R, G, B; R, G, B, A), palettes and transparent colours
/// resolved. Either `bytes` or, for PNG of 16 bits, `words` is filled. No colour management.
struct Raster {
  int width = 0, height = 0, channels = 0;
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint16_t> words;
};

bool isPng(std::span<const std::uint8_t> bytes);
bool isJpeg(std::span<const std::uint8_t> bytes);

/// Called with width and height before memory is taken for them; throws what it does not want.
using SizeCheck = std::function<void(std::int64_t width, std::int64_t height)>;

/// Throws Error(place, …): not such a picture, damaged, truncated, a size beyond kMaxPixels or one that the bytes cannot
/// hold, what `accept` throws.
Raster decodePng(std::span<const std::uint8_t> bytes, const std::string& place, const SizeCheck& accept = {});
Raster decodeJpeg(std::span<const std::uint8_t> bytes, const std::string& place,
                  const SizeCheck& accept = {});
/// Whichever it is.
Raster decodeRaster(std::span<const std::uint8_t> bytes, const std::string& place,
                    const SizeCheck& accept = {});

/// Four channels of 8 bits, as textures want them; opaque where there is no alpha.
std::vector<std::uint8_t> rgba8(const Raster& raster);

}  // namespace gloam
