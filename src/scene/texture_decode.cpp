// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PNG and JPEG through the image room. BMP and TGA, which OBJ files name, through stb_image as a private copy of this
// unit, with no other of its formats: several have a history of bugs.
#include "scene/texture_decode.h"

#include <fmt/format.h>

#include <cstring>
#include <limits>
#include <memory>
#include <string_view>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb_image.h>
#pragma GCC diagnostic pop

#include "image/limits.h"
#include "image/raster.h"

namespace gloam {
namespace {

constexpr std::int64_t kMaxTextureSide = 16384, kMaxTexturePixels = std::int64_t(1) << 26;

/// What the bytes are, where we know and cannot read it.
const char* foreignFormat(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\xabKTX 20")) return "a KTX2 picture; PNG and JPEG are read";
  if (text.size() > 12 && text.starts_with("RIFF") && text.substr(8, 4) == "WEBP")
    return "a WebP picture; PNG and JPEG are read";
  if (text.starts_with("DDS ")) return "a DDS picture; PNG and JPEG are read";
  return nullptr;
}

}  // namespace

Texture decodeTexture(std::span<const std::uint8_t> bytes, const std::string& name, const std::string& place,
                      const std::string& where, ReadBudget& budget) {
  const auto fail = [&](const std::string& message) { throw Error(place, where + ": " + message); };
  if (const char* foreign = foreignFormat(bytes)) fail(foreign);
  if (bytes.empty() || bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    fail(fmt::format("{} bytes are no picture", bytes.size()));
  const auto accept = [&](std::int64_t width, std::int64_t height) {
    if (width < 1 || height < 1 || width > kMaxTextureSide || height > kMaxTextureSide ||
        width * height > kMaxTexturePixels)
      fail(fmt::format("{} x {} pixels; at most {} are read", width, height, kMaxTexturePixels));
    budget.charge(static_cast<std::size_t>(width * height), 4, where);
  };
  Texture texture;
  texture.name = name;
  if (isPng(bytes) || isJpeg(bytes)) {
    const Raster raster = decodeRaster(bytes, place + ": " + where, accept);
    texture.width = raster.width;
    texture.height = raster.height;
    texture.rgba = rgba8(raster);
    return texture;
  }
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  const auto reason = [] {
    return std::string(stbi_failure_reason() ? stbi_failure_reason() : "unknown reason");
  };
  if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels))
    fail("not a PNG or JPEG picture, or a broken one (" + reason() + ")");
  constexpr double kPixelsPerByte = 128.0;  // TGA: runs of 128
  checkPictureSize(place + ": " + where, width, height, bytes.size(), kPixelsPerByte);
  accept(width, height);
  const std::unique_ptr<stbi_uc, void (*)(void*)> rgba(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), stbi_image_free);
  if (!rgba) fail("the picture is broken (" + reason() + ")");
  texture.width = width;
  texture.height = height;
  texture.rgba.assign(rgba.get(), rgba.get() + std::size_t(width) * std::size_t(height) * 4);
  return texture;
}

}  // namespace gloam
