// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gloam/image.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "image/formats.h"
#include "image/limits.h"

namespace gloam {

const Layer* LayeredImage::find(std::string_view name) const {
  const auto found =
      std::find_if(layers.begin(), layers.end(), [&](const Layer& l) { return l.name == name; });
  return found == layers.end() ? nullptr : &*found;
}

Image LayeredImage::image(std::string_view layer, const std::vector<std::string>& channels,
                          const std::string& place) const {
  const Layer* source = find(layer);
  Image result(width, height, static_cast<int>(channels.size()));
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto fullName = [](std::string_view l, const std::string& channel) {
      return l.empty() ? channel : fmt::format("{}.{}", l, channel);
    };
    const auto begin = source ? source->channels.begin() : channels.end();
    const auto end = source ? source->channels.end() : channels.end();
    const auto found = std::find(begin, end, channels[c]);
    if (found == end) {
      std::vector<std::string> names;
      for (const Layer& l : layers)
        for (const std::string& channel : l.channels) names.push_back(fullName(l.name, channel));
      constexpr std::size_t kMany = 12;  // then layers alone
      if (names.size() > kMany) {
        names.clear();
        for (const Layer& l : layers)
          names.push_back(l.name.empty() ? fmt::format("{}", fmt::join(l.channels, "")) : l.name);
      }
      throw Error(place, fmt::format("channel {} is missing; the file has {}", fullName(layer, channels[c]),
                                     oneLine(fmt::format("{}", fmt::join(names, ", ")))));
    }
    const std::size_t stride = source->channels.size(), offset = static_cast<std::size_t>(found - begin);
    for (std::size_t i = 0; i < result.pixelCount(); ++i) {
      const std::size_t from = i * stride + offset;
      result.pixels[i * channels.size() + c] =
          source->type == ChannelType::kUint ? float(source->ids[from]) : source->pixels[from];
    }
  }
  return result;
}

void LayeredImage::add(std::string name, std::vector<std::string> channels, Image image,
                       ChannelType type) {
  if (layers.empty() && width == 0 && height == 0) {
    width = image.width;
    height = image.height;
  }
  if (image.width != width || image.height != height)
    throw Error("layer '" + name + "'", fmt::format("{} x {} pixels were expected, not {} x {}", width,
                                                    height, image.width, image.height));
  if (static_cast<int>(channels.size()) != image.channels)
    throw Error("layer '" + name + "'",
                fmt::format("{} channel names for {} channels", channels.size(), image.channels));
  if (type == ChannelType::kUint) throw Error("layer '" + name + "'", "UINT channels are added with addIds");
  layers.push_back({std::move(name), std::move(channels), type, std::move(image.pixels), {}});
}

void LayeredImage::addIds(std::string name, std::string channel, std::vector<std::uint32_t> ids) {
  if (ids.size() != std::size_t(width) * std::size_t(height))
    throw Error("layer '" + name + "'",
                fmt::format("{} x {} ids were expected, not {}", width, height, ids.size()));
  layers.push_back({std::move(name), {std::move(channel)}, ChannelType::kUint, {}, std::move(ids)});
}

std::optional<PixelPlace> firstNonFinite(const Image& image) {
  const auto bad =
      std::find_if(image.pixels.begin(), image.pixels.end(), [](float v) { return !std::isfinite(v); });
  if (bad == image.pixels.end()) return std::nullopt;
  const std::size_t i = static_cast<std::size_t>(bad - image.pixels.begin());
  const std::size_t pixel = i / std::size_t(image.channels), width = std::size_t(image.width);
  return PixelPlace{int(pixel % width), int(pixel / width), int(i % std::size_t(image.channels)), *bad};
}

void checkWritable(const Image& image, const std::filesystem::path& path) {
  if (image.width < 1 || image.height < 1 || image.channels < 1 || image.channels > 4 ||
      image.pixels.size() != image.pixelCount() * std::size_t(image.channels))
    throw Error(path.string(),
                fmt::format("cannot write: {} x {} pixels of {} channels with {} values are no picture",
                            image.width, image.height, image.channels, image.pixels.size()));
}

Image readImage(const std::filesystem::path& path) {
  std::uint64_t size = 0;
  std::ifstream stream = openForReading(path, &size);
  char magic[8] = {};
  stream.read(magic, sizeof magic);
  stream.close();
  const auto startsWith = [&](const char* bytes, std::size_t count) {
    return size >= count && std::memcmp(magic, bytes, count) == 0;
  };
  try {
    if (startsWith("\x76\x2f\x31\x01", 4)) return readExrPicture(path);
    if (startsWith("#?", 2)) return readHdr(path);
    if (startsWith("\x89PNG\r\n\x1a\n", 8) || startsWith("\xff\xd8\xff", 3)) return readPngOrJpeg(path);
  } catch (const std::bad_alloc&) {
    throw Error(path.string(), "not enough memory for this picture");
  }
  throw Error(path.string(),
              "not a picture that is read here: OpenEXR, Radiance HDR, PNG or JPEG was expected");
}

void writeImage(const Image& image, const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".exr") return writeExr(image, path);
  if (extension == ".hdr") return writeHdr(image, path);
  if (extension == ".png") return writePng(image, path);
  throw Error(path.string(), "a name that ends in .exr, .hdr or .png was expected");
}

}  // namespace gloam
