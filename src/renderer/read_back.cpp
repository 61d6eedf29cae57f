// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/read_back.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/format.h"

namespace gloam {

namespace {

/// The first `channels` of an image on the device; of one in three dimensions the slice in the middle.
Image download(const gpu::ImageRef& ref, int channels) {
  Image image;
  image.width = ref.width();
  image.height = ref.height();
  image.channels = channels;
  image.pixels = ref.image().downloadFloats(ref.range().mip, ref.range().layer, channels);
  const std::size_t slice = image.pixelCount() * std::size_t(channels);
  if (const std::size_t slices = image.pixels.size() / slice; slices > 1) {
    const auto middle = image.pixels.begin() + std::ptrdiff_t(slices / 2 * slice);
    image.pixels = std::vector<float>(middle, middle + std::ptrdiff_t(slice));
  }
  return image;
}

glm::vec3 colorOfNumber(std::uint32_t number) {
  if (number == 0) return glm::vec3(0.0f);
  std::uint32_t h = number * 2654435761u;
  h ^= h >> 15;
  h *= 2246822519u;
  h ^= h >> 13;
  return glm::vec3(h & 255u, (h >> 8) & 255u, (h >> 16) & 255u) / 255.0f * 0.8f + 0.1f;
}

/// False of numbers for a pass to come, and of what stands in where an image is bound and not there.
bool isPicture(const std::string& name) {
  return !name.ends_with("_packed") && !name.ends_with("none") && name != "frame.black";
}

}  // namespace

LayeredImage readLayers(const frame::FrameImages& images, bool parts) {
  LayeredImage result;
  result.width = images.color.width();
  result.height = images.color.height();
  result.add("", {"R", "G", "B", "A"}, download(images.color, 4));
  if (parts) {
    result.add("direct", {"R", "G", "B"}, download(images.direct, 3));
    result.add("indirect", {"R", "G", "B"}, download(images.indirect, 3));
  }
  if (!images.normal) return result;
  result.add("normal", {"X", "Y", "Z"}, download(images.normal, 3));
  result.add("depth", {"Z"}, download(images.depth, 1), ChannelType::kFloat);
  result.add("albedo", {"R", "G", "B"}, download(images.albedo, 3));
  result.addIds("object", "id", images.object.image().download<std::uint32_t>());
  return result;
}

std::vector<std::string> shownNames(const gpu::FrameGraph& graph) {
  std::vector<std::string> names;
  for (const std::string& name : graph.imageNames()) {
    if (isPicture(name)) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

Image readShown(const gpu::FrameGraph& graph, const std::string& name, int width, int height) {
  const gpu::ImageRef ref = isPicture(name) ? graph.find(name) : gpu::ImageRef();
  if (!ref)
    throw Error("show '" + name + "'", fmt::format("no such image in this frame; there are: {}",
                                                   fmt::join(shownNames(graph), ", ")));
  const gpu::FormatInfo& format = gpu::formatInfo(ref.format());
  const Image raw = download(ref, format.channels);
  Image shown(width, height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int from_x = static_cast<int>(std::int64_t(x) * raw.width / width);
      const int from_y = static_cast<int>(std::int64_t(y) * raw.height / height);
      const float* from = raw.at(from_x, from_y);
      float* to = shown.at(x, y);
      if (format.numbers == gpu::Numbers::kUint) {
        const glm::vec3 color =
            colorOfNumber(static_cast<std::uint32_t>(from[0]) +
                          (raw.channels > 1 ? 7919u * static_cast<std::uint32_t>(from[1]) : 0u));
        std::copy(&color.x, &color.x + 3, to);
      } else {
        for (int c = 0; c < 3; ++c) to[c] = raw.channels == 1 ? from[0] : c < raw.channels ? from[c] : 0.0f;
      }
    }
  }
  return shown;
}

}  // namespace gloam
