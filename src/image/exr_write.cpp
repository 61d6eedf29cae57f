// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// EXR through the OpenEXR library: scanlines, ZIP.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <set>

#include "image/atomic_file.h"
#include "image/exr_guard.h"
#include "image/formats.h"
#include "image/limits.h"

namespace gloam {
namespace {

// Values beyond a half's range would become infinite, and an infinite sun poisons whoever reads it.
half toHalf(float value) {
  constexpr float kLargest = 65504.0f;
  return half(std::isnan(value) ? value : std::clamp(value, -kLargest, kLargest));
}

Imf::PixelType pixelType(ChannelType type) {
  return type == ChannelType::kUint ? Imf::UINT : type == ChannelType::kFloat ? Imf::FLOAT : Imf::HALF;
}

void checkLayers(const LayeredImage& image, const std::filesystem::path& path) {
  if (image.width < 1 || image.height < 1 || image.layers.empty())
    throw Error(path.string(), fmt::format("cannot write: {} x {} pixels in {} layers are no picture",
                                           image.width, image.height, image.layers.size()));
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  std::set<std::string> names;
  for (const Layer& layer : image.layers) {
    const std::size_t values = layer.type == ChannelType::kUint ? layer.ids.size() : layer.pixels.size();
    if (layer.channels.empty() || values != pixels * layer.channels.size())
      throw Error(path.string(),
                  fmt::format("cannot write: layer '{}' has {} channels and {} values for {} pixels",
                              layer.name, layer.channels.size(), values, pixels));
    for (const std::string& channel : layer.channels)
      if (channel.empty() || !names.insert(layer.name.empty() ? channel : layer.name + "." + channel).second)
        throw Error(path.string(),
                    fmt::format("cannot write: channel '{}' of layer '{}' has no name or stands twice",
                                channel, layer.name));
  }
}

// What the format itself calls so, whether it stands in this header or not.
bool isReserved(const Imf::Header& header, const std::string& name) {
  static const std::set<std::string> kOthers{"chromaticities", "chunkCount", "name",    "preview",
                                             "tiles",          "type",       "version", "view"};
  return header.find(name) != header.end() || kOthers.count(name) > 0;
}

// Held to what the reader takes, so that what is written comes back. Throws as the library does: writeExr names the file.
void insertAttributes(const LayeredImage& image, Imf::Header& header) {
  if (image.attributes.size() > kMaxStringAttributes)
    throw std::invalid_argument(
        fmt::format("{} attributes; at most {} are kept", image.attributes.size(), kMaxStringAttributes));
  for (const auto& [name, value] : image.attributes) {
    constexpr std::size_t kMaxName = 255;
    if (name.empty() || name.size() > kMaxName || isReserved(header, name))
      throw std::invalid_argument(
          fmt::format("attribute '{}': the name is empty, too long or taken", name.substr(0, 64)));
    if (value.size() > kMaxStringAttributeBytes)
      throw std::invalid_argument(fmt::format("attribute '{}': {} bytes; at most {} are kept", name,
                                              value.size(), kMaxStringAttributeBytes));
    header.insert(name, Imf::StringAttribute(value));
  }
}

void writeLayers(const LayeredImage& image, Imf::OStream& stream) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  insertAttributes(image, header);
  Imf::FrameBuffer buffer;
  std::list<std::vector<half>> halfs;  // kept until the pixels are written
  for (const Layer& layer : image.layers) {
    const char* base = reinterpret_cast<const char*>(layer.pixels.data());
    std::size_t bytes = 4;
    if (layer.type == ChannelType::kUint) base = reinterpret_cast<const char*>(layer.ids.data());
    if (layer.type == ChannelType::kHalf) {
      std::vector<half>& values = halfs.emplace_back(layer.pixels.size());
      std::transform(layer.pixels.begin(), layer.pixels.end(), values.begin(), toHalf);
      base = reinterpret_cast<const char*>(values.data());
      bytes = 2;
    }
    const std::size_t stride = bytes * layer.channels.size();
    for (std::size_t c = 0; c < layer.channels.size(); ++c) {
      const std::string name = layer.name.empty() ? layer.channels[c] : layer.name + "." + layer.channels[c];
      header.channels().insert(name, Imf::Channel(pixelType(layer.type)));
      // The library's slices are not const; it only reads from them here.
      buffer.insert(name, Imf::Slice(pixelType(layer.type), const_cast<char*>(base) + c * bytes, stride,
                                     stride * std::size_t(image.width)));
    }
  }
  Imf::OutputFile output(stream, header);
  output.setFrameBuffer(buffer);
  output.writePixels(image.height);
}

}  // namespace

void writeExr(const LayeredImage& image, const std::filesystem::path& path) {
  checkLayers(image, path);
  AtomicFile file(path);
  try {
    Imf::StdOFStream stream(file.stream(), path.string().c_str());
    writeLayers(image, stream);
  } catch (const std::bad_alloc&) {
    throw Error(path.string(), "not enough memory to write this picture");
  } catch (const std::exception& error) {
    throw Error(path.string(), "cannot write: " + oneLine(error.what()));
  }
  file.commit();
}

void writeExr(const Image& image, const std::filesystem::path& path, ChannelType type) {
  checkWritable(image, path);
  static const std::vector<std::vector<std::string>> kNames{
      {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
  LayeredImage layers;
  layers.add("", kNames[std::size_t(image.channels) - 1], image, type);
  writeExr(layers, path);
}

}  // namespace gloam
