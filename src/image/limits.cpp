// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "image/limits.h"

#include <fmt/format.h>
#include <gloam/error.h>
#include <gloam/image.h>

#include <cerrno>
#include <cstring>

namespace gloam {
namespace fs = std::filesystem;

std::ifstream openForReading(const fs::path& path, std::uint64_t* size_bytes) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    throw Error(path.string(), status.type() == fs::file_type::not_found ? "there is no such file"
                                                                         : "cannot read: " + error.message());
  if (fs::is_directory(status)) throw Error(path.string(), "a file was expected, this is a folder");
  if (!fs::is_regular_file(status))
    throw Error(path.string(), "a file was expected, this is a device or a pipe");
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(path.string(), std::string("cannot read: ") + std::strerror(errno ? errno : EIO));
  *size_bytes = fs::file_size(path, error);
  if (error) throw Error(path.string(), "cannot read: " + error.message());
  if (*size_bytes == 0) throw Error(path.string(), "the file is empty");
  return stream;
}

std::vector<std::uint8_t> readBytes(const fs::path& path) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t(1) << 32;
  std::uint64_t size = 0;
  std::ifstream stream = openForReading(path, &size);
  if (size > kMaxBytes)
    throw Error(path.string(), fmt::format("{} bytes; at most {} are read", size, kMaxBytes));
  std::vector<std::uint8_t> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uint64_t>(stream.gcount()) != size)
    throw Error(path.string(), fmt::format("only {} of {} bytes could be read", stream.gcount(), size));
  return bytes;
}

void checkPictureSize(const std::string& place, std::int64_t width, std::int64_t height,
                      std::uint64_t file_bytes, double pixels_per_byte) {
  if (width < 1 || height < 1)
    throw Error(place, fmt::format("size {} x {}: at least 1 x 1 was expected", width, height));
  const double pixels = static_cast<double>(width) * static_cast<double>(height);
  if (pixels > static_cast<double>(kMaxPixels))
    throw Error(place, fmt::format("size {} x {}: at most {} pixels are read", width, height, kMaxPixels));
  if (pixels > pixels_per_byte * static_cast<double>(file_bytes))
    throw Error(place, fmt::format("size {} x {}: a file of {} bytes cannot hold that many pixels", width,
                                   height, file_bytes));
}

std::string oneLine(std::string text) {
  constexpr std::size_t kMaxLength = 200;
  std::string line;
  for (std::size_t i = 0; i < text.size() && line.size() < kMaxLength;) {
    const auto byte = [&](std::size_t at) {
      return at < text.size() ? static_cast<unsigned char>(text[at]) : 0u;
    };
    const std::size_t length = byte(i) < 0x80   ? 1
                               : byte(i) < 0xc2 ? 0
                               : byte(i) < 0xe0 ? 2
                               : byte(i) < 0xf0 ? 3
                                                : 4;
    bool valid = length > 0 && byte(i) < 0xf5;
    for (std::size_t k = 1; k < length; ++k) valid = valid && (byte(i + k) & 0xc0) == 0x80;
    if (!valid || (length == 1 && (byte(i) < 0x20 || byte(i) == 0x7f))) {
      line += valid ? ' ' : '?';
      ++i;
      continue;
    }
    line.append(text, i, length);
    i += length;
  }
  return line;
}

}  // namespace gloam
