// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "surface_mask.h"

#include <gloam/error.h>

#include <algorithm>
#include <cmath>

namespace gloam::cli {

Image surfaceMask(const LayeredImage& picture, const std::string& place) {
  Image mask(picture.width, picture.height, 1);
  const Layer *objects = picture.find("object"), *light = picture.find("");
  if (objects != nullptr && !objects->ids.empty()) {
    std::ranges::transform(objects->ids, mask.pixels.begin(),
                           [](std::uint32_t id) { return id != 0 ? 1.0f : 0.0f; });
  } else if (light != nullptr && std::ranges::find(light->channels, "A") != light->channels.end()) {
    const Image alpha = picture.image("", {"A"}, place);
    std::ranges::transform(alpha.pixels, mask.pixels.begin(), [](float a) { return a > 0.0f ? 1.0f : 0.0f; });
  } else {
    throw Error(place, "--foreground: neither a layer object.id nor alpha tells where there is a surface");
  }
  if (picture.find("seen") == nullptr) return mask;
  const Image seen = picture.image("seen", {"R", "G", "B"}, place);
  Image lit = mask;
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
    if (seen.pixels[3 * i] > 0.0f || seen.pixels[3 * i + 1] > 0.0f || seen.pixels[3 * i + 2] > 0.0f)
      lit.pixels[i] = 0.0f;
  }
  return std::ranges::any_of(lit.pixels, [](float value) { return value > 0.0f; }) ? lit : mask;
}

std::optional<double> relativeNoise(double variance, const Image& light, const Image& mask) {
  double squares = 0.0;
  for (std::size_t pixel = 0; pixel < mask.pixels.size(); ++pixel) {
    if (mask.pixels[pixel] <= 0.0f) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = double(light.pixels[pixel * std::size_t(light.channels) + c]);
      squares += value * value;
    }
  }
  if (squares <= 0.0) return std::nullopt;
  // Where nothing is seen there is no chance either: all of it is within the mask.
  return std::sqrt(variance * 3.0 * double(mask.pixels.size()) / squares);
}

}  // namespace gloam::cli
