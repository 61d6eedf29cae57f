// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "diff_inputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "arguments.h"
#include "surface_mask.h"

namespace gloam::cli {
namespace {

enum class Kind { kExr, kDisplay, kOther };

// By the first bytes, as readImage tells them.
Kind kindOf(const std::string& path) {
  std::string head(4, '\0');
  std::ifstream(path, std::ios::binary).read(head.data(), std::streamsize(head.size()));
  using namespace std::string_view_literals;
  if (head == "\x76\x2f\x31\x01"sv) return Kind::kExr;
  return head == "\x89PNG"sv || head.starts_with("\xff\xd8\xff"sv) ? Kind::kDisplay : Kind::kOther;
}

std::string placeOf(const std::string& path, const std::string& layer) {
  return layer.empty() ? path : fmt::format("{}: layer {}", path, layer);
}

std::vector<std::string> layerNames(const LayeredImage& image) {
  std::vector<std::string> names;
  for (const Layer& layer : image.layers) {
    if (!layer.name.empty() && layer.type != ChannelType::kUint) names.push_back(singleLine(layer.name));
  }
  return names;
}

Image readLayer(const std::string& path, const std::string& name) {
  if (kindOf(path) != Kind::kExr) {
    readImage(path);  // what is wrong with the file itself comes first
    throw Error(path, fmt::format("--layer {}: only OpenEXR files have layers", name));
  }
  const LayeredImage image = readExr(path);
  const Layer* layer = image.find(name);
  if (layer == nullptr) {
    const std::vector<std::string> names = layerNames(image);
    throw Error(path, fmt::format("layer {} is missing{}; the file has {}", name, didYouMean(name, names),
                                  names.empty() ? "none" : CLI::detail::join(names, ", ")));
  }
  if (layer->type == ChannelType::kUint) {
    throw Error(placeOf(path, name), "holds whole numbers that name things; they have no distance");
  }
  const auto has = [&](const char* channel) {
    return std::ranges::find(layer->channels, channel) != layer->channels.end();
  };
  if (has("R") && has("G") && has("B")) return image.image(name, {"R", "G", "B"}, path);
  if (layer->channels.size() == 1 || layer->channels.size() == 3)
    return image.image(name, layer->channels, path);
  throw Error(placeOf(path, name), fmt::format("one channel, or R, G and B were expected, not {}",
                                               singleLine(CLI::detail::join(layer->channels, ", "))));
}

/// One channel or three: without alpha.
Image colorsOf(Image image, int channels) {
  if (image.channels == channels) return image;
  Image result(image.width, image.height, channels);
  for (std::size_t i = 0; i < image.pixelCount(); ++i) {
    for (int c = 0; c < channels; ++c) {
      const std::size_t from = image.channels >= 3 ? std::size_t(c) : 0;
      result.pixels[i * std::size_t(channels) + std::size_t(c)] =
          image.pixels[i * std::size_t(image.channels) + from];
    }
  }
  return result;
}

void requireFinite(const Image& image, const std::string& place) {
  if (const auto bad = firstNonFinite(image)) {
    throw Error(place, fmt::format("pixel ({}, {}) is not finite: {}", bad->x, bad->y, bad->value));
  }
}

void requireSize(const Image& image, const std::string& place, const Image& reference,
                 const std::string& reference_place) {
  if (image.width == reference.width && image.height == reference.height) return;
  throw Error(place, fmt::format("{}x{} pixels, but {} has {}x{}; one size is expected", image.width,
                                 image.height, reference_place, reference.width, reference.height));
}

Image fileMask(const std::string& path) {
  const Image image = readImage(path);
  const std::size_t channels = std::size_t(image.channels), colors = image.channels >= 3 ? 3 : 1;
  Image mask(image.width, image.height, 1);
  for (std::size_t i = 0; i < mask.pixelCount(); ++i) {
    for (std::size_t c = 0; c < colors; ++c) {
      const float value = image.pixels[i * channels + c];
      if (!std::isfinite(value)) {
        const std::size_t x = i % std::size_t(image.width), y = i / std::size_t(image.width);
        throw Error(path, fmt::format("pixel ({}, {}) of the mask is {}; expected a number", x, y, value));
      }
      if (value != 0.0f) mask.pixels[i] = 1.0f;
    }
  }
  return mask;
}

/// Where the file says that there is a surface: an .exr by its layers, others by alpha.
Image foregroundOf(const std::string& path) {
  if (kindOf(path) == Kind::kExr) return surfaceMask(readExr(path), path);
  const Image image = readImage(path);
  if (image.channels != 2 && image.channels != 4) {
    throw Error(path, "--foreground: neither a layer object.id nor alpha tells where there is a surface");
  }
  Image mask(image.width, image.height, 1);
  for (std::size_t i = 0; i < mask.pixelCount(); ++i) {
    mask.pixels[i] = image.pixels[(i + 1) * std::size_t(image.channels) - 1] > 0.0f ? 1.0f : 0.0f;
  }
  return mask;
}

Image maskOf(const DiffInputs& inputs, const Image& reference) {
  Image mask;
  if (!inputs.mask.empty()) {
    mask = fileMask(inputs.mask);
    requireSize(mask, inputs.mask, reference, inputs.reference);
  }
  if (inputs.foreground) {
    Image surfaces = foregroundOf(inputs.reference);
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) surfaces.pixels[i] *= mask.pixels[i];
    mask = std::move(surfaces);
  }
  if (!mask.empty() && std::ranges::all_of(mask.pixels, [](float value) { return value == 0.0f; })) {
    throw Error(inputs.mask.empty() ? inputs.reference : inputs.mask, "the mask leaves no pixel to compare");
  }
  return mask;
}

}  // namespace

DiffPair readPair(const DiffInputs& inputs, std::string& remark) {
  const auto read = [&](const std::string& path) {
    return inputs.layer.empty() ? readImage(path) : readLayer(path, inputs.layer);
  };
  DiffPair pair;
  pair.picture = read(inputs.picture);
  pair.reference = read(inputs.reference);
  const int channels = std::max(pair.picture.channels, pair.reference.channels) >= 3 ? 3 : 1;
  pair.picture = colorsOf(std::move(pair.picture), channels);
  pair.reference = colorsOf(std::move(pair.reference), channels);
  requireSize(pair.picture, placeOf(inputs.picture, inputs.layer), pair.reference, inputs.reference);
  requireFinite(pair.picture, placeOf(inputs.picture, inputs.layer));
  requireFinite(pair.reference, placeOf(inputs.reference, inputs.layer));
  pair.mask = maskOf(inputs, pair.reference);

  const bool shown = kindOf(inputs.picture) == Kind::kDisplay;
  pair.display = shown && kindOf(inputs.reference) == Kind::kDisplay;
  if (shown != (kindOf(inputs.reference) == Kind::kDisplay)) {
    const auto& [display, radiance] =
        shown ? std::tie(inputs.picture, inputs.reference) : std::tie(inputs.reference, inputs.picture);
    remark = fmt::format("{} holds light of a display, {} radiance: compared as they are", display, radiance);
  }
  return pair;
}

}  // namespace gloam::cli
