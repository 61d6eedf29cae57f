// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "show.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace gloam::cli {
namespace {

constexpr const char* kFrame = "frame";

Image normalColors(const LayeredImage& frame) {
  Image image = frame.image("normal", {"X", "Y", "Z"}, kFrame);
  for (float& value : image.pixels) value = value * 0.5f + 0.5f;
  return image;
}

Image depthGrey(const LayeredImage& frame) {
  Image image = frame.image("depth", {"Z"}, kFrame);
  float nearest = INFINITY, farthest = 0.0f;
  const auto hit = [](float z) { return std::isfinite(z) && z > 0.0f && z < 1e30f; };
  for (const float z : image.pixels) {
    if (hit(z)) nearest = std::min(nearest, z), farthest = std::max(farthest, z);
  }
  const float span = std::max(farthest - nearest, 1e-6f);
  for (float& z : image.pixels) z = hit(z) ? 1.0f - 0.9f * (z - nearest) / span : 0.0f;
  return image;
}

// The golden ratio spreads hues evenly, however many objects there are.
Image objectColors(const LayeredImage& frame) {
  const Layer* layer = frame.find("object");
  if (layer == nullptr || layer->ids.empty()) throw Error(kFrame, "layer object is missing");
  Image image(frame.width, frame.height, 3);
  for (std::size_t i = 0; i < image.pixelCount(); ++i) {
    const std::uint32_t id = layer->ids[i];
    const float hue = 6.0f * float(std::fmod(double(id) * 0.618033988749895, 1.0));
    for (int c = 0; c < 3; ++c) {
      const float wave = std::abs(std::fmod(hue + 4.0f * float(c), 6.0f) - 3.0f) - 1.0f;
      image.pixels[i * 3 + std::size_t(c)] = id == 0 ? 0.0f : 0.15f + 0.7f * std::clamp(wave, 0.0f, 1.0f);
    }
  }
  return image;
}

/// Depths, fluxes and the like may be small numbers: where all would be near black, they are raised by whole stops until the
/// brightest hundredth is not.
void raise(Image& image) {
  constexpr float kDark = 0.06f, kBright = 0.75f, kMostStops = 40.0f;
  std::vector<float> most(image.pixelCount());
  for (std::size_t i = 0; i < most.size(); ++i) {
    const float* p = &image.pixels[i * std::size_t(image.channels)];
    most[i] = std::max({p[0], p[1], p[2]});
    if (!std::isfinite(most[i])) most[i] = 0.0f;
  }
  if (most.empty()) return;
  const auto high = most.begin() + std::ptrdiff_t((most.size() - 1) * 99 / 100);
  std::nth_element(most.begin(), high, most.end());
  if (*high <= 0.0f || *high >= kDark) return;
  const float gain = std::exp2(std::min(std::floor(std::log2(kBright / *high)), kMostStops));
  for (float& value : image.pixels) value *= gain;
}

}  // namespace

const std::vector<std::string>& frameLayers() {
  static const std::vector<std::string> kLayers = {"direct", "indirect", "normal",      "depth",
                                                   "albedo", "object",   kSpheresLayer, kShadowSpheresLayer};
  return kLayers;
}

bool showsSpheres(const std::string& layer) {
  return layer == kSpheresLayer || layer == kShadowSpheresLayer;
}

bool isFrameLayer(const std::string& name) {
  return std::ranges::find(frameLayers(), name) != frameLayers().end();
}

Image lightOf(const LayeredImage& frame, const std::string& layer) {
  if (layer.empty()) return frame.image("", {"R", "G", "B", "A"}, kFrame);
  return frame.image(layer, {"R", "G", "B"}, kFrame);
}

Image shownPicture(const LayeredImage& frame, const std::string& layer, const DisplayOptions& display) {
  if (layer == "normal") return normalColors(frame);
  if (layer == "depth") return depthGrey(frame);
  if (showsSpheres(layer)) return frame.image(layer, {"R", "G", "B"}, kFrame);
  if (layer == "albedo") return frame.image("albedo", {"R", "G", "B"}, kFrame);
  if (layer == "object") return objectColors(frame);
  Image image = lightOf(frame, layer);
  if (!layer.empty() && !isFrameLayer(layer)) raise(image);
  return toneMapped(image, display);
}

}  // namespace gloam::cli
