// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What stands between a number in a file and memory that is taken because of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace gloam {

/// Opens a regular file for reading and tells its size. Throws Error (missing, a folder, no permission,
/// empty).
std::ifstream openForReading(const std::filesystem::path& path, std::uint64_t* size_bytes);

/// The whole file. Throws Error, also above 4 GiB.
std::vector<std::uint8_t> readBytes(const std::filesystem::path& path);

/// Throws Error(place, …) unless both sides are at least 1, their product at most kMaxPixels, and the file of
/// `file_bytes` could hold that many pixels at `pixels_per_byte`, the best that its coding can do.
void checkPictureSize(const std::string& place, std::int64_t width, std::int64_t height,
                      std::uint64_t file_bytes, double pixels_per_byte);

/// Bytes of a file as a text for a message: one line, no control characters, UTF-8 (others become ?), about 200 bytes.
std::string oneLine(std::string text);

}  // namespace gloam
