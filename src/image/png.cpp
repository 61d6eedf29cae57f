// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PNG and JPEG through stb. stb fills what is missing at a file's end with zeros and says nothing: both
// formats are walked once before, so that a truncated file is an error.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb_image.h>
#include <stb_image_write.h>
#pragma GCC diagnostic pop

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>

#include "image/atomic_file.h"
#include "image/color.h"
#include "image/formats.h"
#include "image/limits.h"
#include "image/tonemap.h"

namespace gloam {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct StbFree {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

template <typename Texel>
Image linearImage(const Texel* texels, int width, int height, int channels) {
  constexpr std::size_t kLevels = std::size_t(1) << (8 * sizeof(Texel));
  std::vector<float> linear(kLevels);
  for (std::size_t i = 0; i < kLevels; ++i) linear[i] = srgbDecode(float(i) / float(kLevels - 1));
  Image image(width, height, channels);
  const bool alpha = channels == 2 || channels == 4;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const bool is_alpha = alpha && int(i % std::size_t(channels)) == channels - 1;
    image.pixels[i] = is_alpha ? float(texels[i]) / float(kLevels - 1) : linear[texels[i]];
  }
  return image;
}

void append(void* out, void* data, int size) {
  auto* bytes = static_cast<Bytes*>(out);
  const auto* begin = static_cast<const std::uint8_t*>(data);
  bytes->insert(bytes->end(), begin, begin + size);
}

}  // namespace

void checkPngIsWhole(std::span<const std::uint8_t> bytes, const std::string& place) {
  const auto word = [&](std::size_t at) {
    return std::uint32_t(bytes[at]) << 24 | std::uint32_t(bytes[at + 1]) << 16 |
           std::uint32_t(bytes[at + 2]) << 8 | bytes[at + 3];
  };
  for (std::size_t at = 8; at <= bytes.size() && bytes.size() - at >= 12;) {
    const std::uint64_t length = word(at);
    if (length > bytes.size() - at - 12)
      throw Error(place,
                  fmt::format("PNG chunk of {} bytes at {} reaches past the end of the file", length, at));
    if (std::memcmp(&bytes[at + 4], "IEND", 4) == 0) return;
    at += length + 12;
  }
  throw Error(place, "the file ends before the PNG chunk IEND");
}

// Segments up to the first scan, then anything up to the marker that ends the picture.
void checkJpegIsWhole(std::span<const std::uint8_t> bytes, const std::string& place) {
  constexpr std::uint8_t kStartOfScan = 0xda, kEnd = 0xd9;
  std::size_t at = 2;
  while (at + 4 <= bytes.size() && bytes[at] == 0xff && bytes[at + 1] != kStartOfScan) {
    if (bytes[at + 1] == 0xff) {  // padding
      ++at;
      continue;
    }
    at += 2 + (std::size_t(bytes[at + 2]) << 8 | bytes[at + 3]);
  }
  for (std::size_t i = std::min(at, bytes.size()); i + 1 < bytes.size(); ++i)
    if (bytes[i] == 0xff && bytes[i + 1] == kEnd) return;
  throw Error(place, "the file ends before the JPEG marker EOI");
}

Image readPngOrJpeg(const std::filesystem::path& path) {
  const std::string place = path.string();
  const Bytes bytes = readBytes(path);
  if (bytes.size() > std::size_t(1) << 30) throw Error(place, "PNG and JPEG files are read up to 1 GiB");
  const bool png = bytes.size() >= 8 && bytes[0] == 0x89;
  if (png)
    checkPngIsWhole(bytes, place);
  else
    checkJpegIsWhole(bytes, place);

  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  const auto refuse = [&]() -> Error {
    const char* reason = stbi_failure_reason();
    return Error(place, fmt::format("not a readable {}: {}", png ? "PNG" : "JPEG",
                                    oneLine(reason ? reason : "unknown")));
  };
  if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels)) throw refuse();
  // PNG: one bit a pixel behind zlib's 1032 to 1; JPEG: a bit a block of 16 x 16 pixels.
  checkPictureSize(place, width, height, bytes.size(), png ? 8.0 * 1032.0 : 8.0 * 256.0);
  if (png && stbi_is_16_bit_from_memory(bytes.data(), size)) {
    std::unique_ptr<stbi_us, StbFree> texels(
        stbi_load_16_from_memory(bytes.data(), size, &width, &height, &channels, 0));
    if (!texels) throw refuse();
    return linearImage(texels.get(), width, height, channels);
  }
  std::unique_ptr<stbi_uc, StbFree> texels(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 0));
  if (!texels) throw refuse();
  return linearImage(texels.get(), width, height, channels);
}

std::vector<std::uint8_t> encodeSrgb8(const Image& image) {
  const bool alpha = image.channels == 2 || image.channels == 4;
  std::vector<std::uint8_t> bytes(image.pixels.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const bool is_alpha = alpha && int(i % std::size_t(image.channels)) == image.channels - 1;
    const float value = image.pixels[i] > 0.0f ? std::min(image.pixels[i], 1.0f) : 0.0f;  // also not-a-number
    bytes[i] = static_cast<std::uint8_t>((is_alpha ? value : srgbEncode(value)) * 255.0f + 0.5f);
  }
  return bytes;
}

void writePng(const Image& image, const std::filesystem::path& path) {
  checkWritable(image, path);
  constexpr std::size_t kMaxBytes = std::size_t(1) << 30;  // stb counts in int
  if (image.pixels.size() > kMaxBytes) throw Error(path.string(), "PNG: the picture is larger than 1 GiB");
  AtomicFile file(path);
  const Bytes texels = encodeSrgb8(image);
  Bytes packed;
  if (!stbi_write_png_to_func(append, &packed, image.width, image.height, image.channels, texels.data(),
                              image.width * image.channels))
    throw Error(path.string(), "not enough memory to pack this picture");
  file.write(packed.data(), packed.size());
  file.commit();
}

}  // namespace gloam
