// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pictures of 8 and 16 bits: PNG and JPEG read to linear values, PNG written.
#include <fmt/format.h>
#include <png.h>

#include <cmath>
#include <limits>

#include "image/atomic_file.h"
#include "image/color.h"
#include "image/formats.h"
#include "image/limits.h"
#include "image/raster.h"
#include "image/tonemap.h"

namespace gloam {
namespace {

bool isAlpha(std::size_t value, int channels) {
  return (channels == 2 || channels == 4) && value % std::size_t(channels) == std::size_t(channels) - 1;
}

template <typename Texel>
Image linearImage(const Raster& raster, const std::vector<Texel>& texels) {
  constexpr std::size_t kLevels = std::size_t(std::numeric_limits<Texel>::max()) + 1;
  std::vector<float> linear(kLevels);
  for (std::size_t i = 0; i < kLevels; ++i) linear[i] = srgbDecode(float(i) / float(kLevels - 1));
  Image image(raster.width, raster.height, raster.channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = isAlpha(i, raster.channels) ? float(texels[i]) / float(kLevels - 1) : linear[texels[i]];
  return image;
}

}  // namespace

Raster decodeRaster(std::span<const std::uint8_t> bytes, const std::string& place, const SizeCheck& accept) {
  if (isPng(bytes)) return decodePng(bytes, place, accept);
  if (isJpeg(bytes)) return decodeJpeg(bytes, place, accept);
  throw Error(place, "PNG or JPEG was expected");
}

std::vector<std::uint8_t> rgba8(const Raster& raster) {
  const std::size_t pixels = std::size_t(raster.width) * std::size_t(raster.height);
  const std::size_t channels = std::size_t(raster.channels), green = channels >= 3 ? 1 : 0;
  const auto value = [&](std::size_t i) {
    return raster.words.empty() ? raster.bytes[i] : std::uint8_t((raster.words[i] * 255u + 32767u) / 65535u);
  };
  std::vector<std::uint8_t> result(pixels * 4);
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < 3; ++c) result[4 * i + c] = value(i * channels + c * green);
    result[4 * i + 3] = channels % 2 == 0 ? value((i + 1) * channels - 1) : 255;
  }
  return result;
}

Image readPngOrJpeg(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = readBytes(path);
  const Raster raster = decodeRaster(bytes, path.string());
  return raster.words.empty() ? linearImage(raster, raster.bytes) : linearImage(raster, raster.words);
}

std::vector<std::uint8_t> encodeSrgb8(const Image& image) {
  std::vector<std::uint8_t> bytes(image.pixels.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const float value = image.pixels[i] > 0.0f ? std::min(image.pixels[i], 1.0f) : 0.0f;  // also not-a-number
    bytes[i] =
        static_cast<std::uint8_t>((isAlpha(i, image.channels) ? value : srgbEncode(value)) * 255.0f + 0.5f);
  }
  return bytes;
}

void writePng(const Image& image, const std::filesystem::path& path) {
  checkWritable(image, path);
  AtomicFile file(path);
  const std::vector<std::uint8_t> texels = encodeSrgb8(image);
  constexpr png_uint_32 kFormats[] = {PNG_FORMAT_GRAY, PNG_FORMAT_GA, PNG_FORMAT_RGB, PNG_FORMAT_RGBA};
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = png_uint_32(image.width);
  png.height = png_uint_32(image.height);
  png.format = kFormats[image.channels - 1];
  // Room for the worst case (data that do not pack); the library refuses what it cannot count.
  std::vector<std::uint8_t> packed(texels.size() + texels.size() / 16 + std::size_t(image.height) + 4096);
  png_alloc_size_t size = packed.size();
  if (!png_image_write_to_memory(&png, packed.data(), &size, 0, texels.data(), 0, nullptr))
    throw Error(path.string(), "cannot write: " + oneLine(png.message));
  file.write(packed.data(), size);
  file.commit();
}

}  // namespace gloam
