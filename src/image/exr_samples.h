// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// EXR files of every form that the tests need, written with the OpenEXR library itself.
#pragma once

#include <ImfChromaticities.h>
#include <ImfCompression.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace gloam::test {

struct ExrSample {
  int width = 9, height = 7;                  ///< of the data window
  int data_x = 0, data_y = 0;                 ///< its corner
  int display_x = 0, display_y = 0;           ///< of the display window
  int display_width = 0, display_height = 0;  ///< 0: the data window's
  Imf::Compression compression = Imf::ZIP_COMPRESSION;
  std::vector<std::string> channels{"R", "G", "B"};
  std::string type = "half";  ///< or "float", "uint"
  int tile = 0;               ///< 0: scanlines
  int sampling = 1;           ///< of the last channel
  std::optional<Imf::Chromaticities> chromaticities;
  std::map<std::string, std::string> attributes;
};

/// Value of the c-th channel at (x, y) of the data window: an integer, exact in every type and close in lossy codings.
inline float sampleValue(int c, int x, int y) {
  return float(16 * c + x + 2 * y);
}

void writeSample(const ExrSample& sample, const std::filesystem::path& path);
/// Part 0 deep, part 1 the given sample (scanlines), part 2 another size.
void writeSeveralParts(const ExrSample& sample, const std::filesystem::path& path);
void writeDeep(const std::filesystem::path& path);

}  // namespace gloam::test
