// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// EXR through the OpenEXR library, behind the checks of exr_guard.h. Whatever the library throws becomes one
// line.
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "image/color.h"
#include "image/exr_guard.h"
#include "image/formats.h"
#include "image/limits.h"

namespace gloam {
namespace {

struct Parsed {
  LayeredImage picture;
  std::vector<std::string> channels;  ///< all that the part has
  glm::mat3 rec709_from_stored{1.0f};
};

/// Which channels are read, seen all that the part has.
using Choose = std::function<std::vector<ExrChannel>(const ExrPart&)>;

std::string layerOf(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  return dot == std::string::npos ? "" : channel.substr(0, dot);
}

int rankOf(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  const std::string name = dot == std::string::npos ? channel : channel.substr(dot + 1);
  const std::size_t rank = std::string("RGBA").find(name);
  return name.size() == 1 && rank != std::string::npos ? int(rank) : 4;
}

// Layers in the file's order (alphabetical), the one without a name first; R, G, B, A in that order within.
std::vector<Layer> emptyLayers(std::vector<ExrChannel> channels) {
  std::stable_sort(channels.begin(), channels.end(), [](const ExrChannel& a, const ExrChannel& b) {
    const std::string layer_a = layerOf(a.name), layer_b = layerOf(b.name);
    return layer_a != layer_b ? layer_a < layer_b : rankOf(a.name) < rankOf(b.name);
  });
  constexpr std::array<ChannelType, 3> kTypes{ChannelType::kUint, ChannelType::kHalf, ChannelType::kFloat};
  std::vector<Layer> layers;
  for (const ExrChannel& channel : channels) {
    const std::string layer = layerOf(channel.name);
    const ChannelType type = kTypes[std::size_t(channel.type)];
    if (layers.empty() || layers.back().name != layer) layers.push_back({layer, {}, type, {}, {}});
    if (layers.back().type != type) layers.back().type = ChannelType::kFloat;
    layers.back().channels.push_back(channel.name.substr(layer.empty() ? 0 : layer.size() + 1));
  }
  return layers;
}

Imf::FrameBuffer allocate(std::vector<Layer>& layers, const ExrWindow& data) {
  const std::size_t width = std::size_t(data.width()), pixels = width * std::size_t(data.height());
  const Imath::Box2i window({data.min_x, data.min_y}, {data.max_x, data.max_y});
  Imf::FrameBuffer buffer;
  for (Layer& layer : layers) {
    const bool ids = layer.type == ChannelType::kUint;
    const std::size_t count = layer.channels.size(), stride = count * 4;
    if (ids)
      layer.ids.resize(pixels * count);
    else
      layer.pixels.resize(pixels * count);
    for (std::size_t c = 0; c < count; ++c) {
      const void* first = ids ? static_cast<const void*>(&layer.ids[c]) : &layer.pixels[c];
      const std::string name = layer.name.empty() ? layer.channels[c] : layer.name + "." + layer.channels[c];
      buffer.insert(name,
                    Imf::Slice::Make(ids ? Imf::UINT : Imf::FLOAT, first, window, stride, stride * width));
    }
  }
  return buffer;
}

template <typename T>
std::vector<T> moved(const std::vector<T>& from, std::size_t channels, const ExrWindow& data,
                     const ExrWindow& display) {
  if (from.empty()) return {};
  std::vector<T> to(std::size_t(display.width()) * std::size_t(display.height()) * channels, T(0));
  const std::int32_t left = std::max(data.min_x, display.min_x), right = std::min(data.max_x, display.max_x);
  for (std::int32_t y = std::max(data.min_y, display.min_y); y <= std::min(data.max_y, display.max_y); ++y) {
    const auto row = [&](const ExrWindow& w) {
      return ((std::int64_t(y) - w.min_y) * w.width() + (std::int64_t(left) - w.min_x)) *
             std::int64_t(channels);
    };
    const std::int64_t count = (std::int64_t(right) - left + 1) * std::int64_t(channels);
    std::copy_n(from.begin() + row(data), count, to.begin() + row(display));
  }
  return to;
}

// The picture is what the display window shows.
void fitToDisplay(LayeredImage& picture, const ExrPart& part, const std::string& place) {
  const ExrWindow &data = part.data, &display = part.display;
  picture.width = int(display.width());
  picture.height = int(display.height());
  if (data == display) return;
  if (data.min_x > display.max_x || data.max_x < display.min_x || data.min_y > display.max_y ||
      data.max_y < display.min_y)
    throw Error(place, "dataWindow and displayWindow do not overlap");
  constexpr double kMaxGrowth = 64.0, kAlwaysAllowed = 1 << 20;
  const double shown = double(display.width()) * double(display.height());
  if (shown > std::max(kAlwaysAllowed, kMaxGrowth * double(data.width()) * double(data.height())))
    throw Error(place, fmt::format("displayWindow {} x {} is out of proportion to dataWindow {} x {}",
                                   display.width(), display.height(), data.width(), data.height()));
  for (Layer& layer : picture.layers) {
    layer.pixels = moved(layer.pixels, layer.channels.size(), data, display);
    layer.ids = moved(layer.ids, layer.channels.size(), data, display);
  }
}

glm::mat3 rec709FromHeader(const Imf::Header& header, const std::string& place) {
  const auto* attribute = header.findTypedAttribute<Imf::ChromaticitiesAttribute>("chromaticities");
  if (!attribute) return glm::mat3(1.0f);
  const Imf::Chromaticities& c = attribute->value();
  const glm::mat3 matrix = rec709From(
      {{{c.red.x, c.red.y}, {c.green.x, c.green.y}, {c.blue.x, c.blue.y}, {c.white.x, c.white.y}}});
  if (matrix == glm::mat3(0.0f)) throw Error(place, "attribute chromaticities: they span no colour space");
  return matrix;
}

// "name" and "type" belong to the format.
std::map<std::string, std::string> stringAttributes(const Imf::Header& header) {
  std::map<std::string, std::string> attributes;
  for (auto entry = header.begin(); entry != header.end(); ++entry) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&entry.attribute());
    const std::string name = entry.name();
    if (!text || name == "name" || name == "type" || text->value().size() > kMaxStringAttributeBytes)
      continue;
    if (attributes.size() < kMaxStringAttributes) attributes.emplace(name, text->value());
  }
  return attributes;
}

Parsed parse(const std::filesystem::path& path, const Choose& choose) {
  const std::string place = path.string();
  std::uint64_t size = 0;
  std::ifstream stream = openForReading(path, &size);
  const std::vector<ExrPart> parts = checkExrHeaders(stream, size, place);
  const auto flat = std::find_if(parts.begin(), parts.end(), [](const ExrPart& part) { return !part.deep; });
  if (flat == parts.end()) throw Error(place, "deep pictures are not read; a flat one was expected");
  const std::vector<ExrChannel> chosen = choose(*flat);

  stream.clear();
  stream.seekg(0);
  Imf::StdIFStream input(stream, place.c_str());
  Imf::MultiPartInputFile file(input);
  Imf::InputPart part(file, int(flat - parts.begin()));
  const Imath::Box2i& window = part.header().dataWindow();
  if (window.min != Imath::V2i(flat->data.min_x, flat->data.min_y) ||
      window.max != Imath::V2i(flat->data.max_x, flat->data.max_y))
    throw Error(place, "its headers contradict each other");

  Parsed result;
  result.rec709_from_stored = rec709FromHeader(part.header(), place);
  result.picture.layers = emptyLayers(chosen);
  result.picture.attributes = stringAttributes(part.header());
  part.setFrameBuffer(allocate(result.picture.layers, flat->data));
  part.readPixels(flat->data.min_y, flat->data.max_y);
  fitToDisplay(result.picture, *flat, place);
  return result;
}

// The library's messages start with 'Cannot read image file "NAME". ' or the like; the name stands before
// already.
Parsed parseSafely(const std::filesystem::path& path, const Choose& choose) {
  const std::string place = path.string();
  try {
    return parse(path, choose);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(place, "not enough memory for this picture");
  } catch (const std::exception& error) {
    std::string text = error.what();
    const std::string quoted = "\"" + place + "\"";
    if (const std::size_t at = text.find(quoted); at != std::string::npos) {
      const std::size_t end = text.find_first_not_of(". ", at + quoted.size());
      if (end != std::string::npos) text.erase(0, end);
    }
    throw Error(place, "OpenEXR: " + oneLine(text));
  } catch (...) {
    throw Error(place, "OpenEXR: the file is damaged");
  }
}

std::vector<ExrChannel> allChannels(const ExrPart& part, const std::string& place) {
  for (const ExrChannel& channel : part.channels)
    if (channel.x_sampling != 1 || channel.y_sampling != 1)
      throw Error(place, "channel " + oneLine(channel.name) + " is subsampled; only full resolution is read");
  return part.channels;
}

// R, G, B and A where present; else Y and A.
std::vector<ExrChannel> pictureChannels(const ExrPart& part, const std::string& place) {
  const auto find = [&](const std::string& name) {
    const auto found = std::find_if(part.channels.begin(), part.channels.end(),
                                    [&](const ExrChannel& channel) { return channel.name == name; });
    return found == part.channels.end() ? nullptr : &*found;
  };
  const bool color = find("R") || find("G") || find("B") || !find("Y");
  if (!color && (find("RY") || find("BY")))
    throw Error(place, "luminance and chroma (Y, RY, BY) are not read; R, G, B were expected");
  std::string names;
  for (const ExrChannel& channel : part.channels) names += (names.empty() ? "" : ", ") + channel.name;
  ExrPart chosen;
  for (const char* name : color ? std::vector<const char*>{"R", "G", "B"} : std::vector<const char*>{"Y"}) {
    if (!find(name))
      throw Error(place, fmt::format("channel {} is missing; the file has {}", name, oneLine(names)));
    chosen.channels.push_back(*find(name));
  }
  if (find("A")) chosen.channels.push_back(*find("A"));
  return allChannels(chosen, place);
}

}  // namespace

LayeredImage readExr(const std::filesystem::path& path) {
  return parseSafely(path, [&](const ExrPart& part) { return allChannels(part, path.string()); }).picture;
}

Image readExrPicture(const std::filesystem::path& path) {
  Parsed parsed =
      parseSafely(path, [&](const ExrPart& part) { return pictureChannels(part, path.string()); });
  Layer& layer = parsed.picture.layers.front();
  Image image;
  image.width = parsed.picture.width;
  image.height = parsed.picture.height;
  image.channels = int(layer.channels.size());
  if (layer.type == ChannelType::kUint)
    image.pixels.assign(layer.ids.begin(), layer.ids.end());
  else
    image.pixels = std::move(layer.pixels);
  // "Y" and "A" are sorted by name: luminance first.
  if (layer.channels.front() == "A")
    for (std::size_t i = 0; i < image.pixelCount(); ++i)
      std::swap(image.pixels[2 * i], image.pixels[2 * i + 1]);
  if (image.channels < 3 || parsed.rec709_from_stored == glm::mat3(1.0f)) return image;
  for (std::size_t i = 0; i < image.pixelCount(); ++i) {
    float* p = &image.pixels[i * std::size_t(image.channels)];
    const glm::vec3 color = parsed.rec709_from_stored * glm::vec3(p[0], p[1], p[2]);
    for (int c = 0; c < 3; ++c) p[c] = color[c];
  }
  return image;
}

}  // namespace gloam
