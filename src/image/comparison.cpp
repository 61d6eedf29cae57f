// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "image/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/tonemap.h"

namespace gloam {
namespace {

void requireFinite(const Image& image, const char* which) {
  const std::size_t colors = std::size_t(colorChannels(image)), channels = std::size_t(image.channels);
  for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
    for (std::size_t c = 0; c < colors; ++c) {
      if (std::isfinite(image.pixels[pixel * channels + c])) continue;
      const std::size_t width = std::size_t(image.width);
      throw Error(fmt::format("pixel ({}, {}) is not finite in the {}", pixel % width, pixel / width, which));
    }
  }
}

}  // namespace

void requireComparable(const Image& a, const Image& reference) {
  if (a.width != reference.width || a.height != reference.height || a.channels != reference.channels)
    throw Error(
        fmt::format("pictures of one size were expected, not {} x {} with {} channels and {} x {} with {}",
                    a.width, a.height, a.channels, reference.width, reference.height, reference.channels));
  if (a.empty()) throw Error("pictures without pixels cannot be compared");
  requireFinite(a, "picture");
  requireFinite(reference, "reference");
}

void requireMask(const Image& mask, const Image& reference) {
  if (mask.empty()) return;
  if (mask.width != reference.width || mask.height != reference.height || mask.channels != 1)
    throw Error("mask",
                fmt::format("{} x {} pixels of one channel were expected, not {} x {} with {}",
                            reference.width, reference.height, mask.width, mask.height, mask.channels));
  requireFinite(mask, "mask");
  if (std::ranges::all_of(mask.pixels, [](float value) { return value == 0.0f; }))
    throw Error("mask", "no pixel is left to compare");
}

void requirePixelsPerDegree(double pixels_per_degree) {
  if (!(pixels_per_degree >= 1.0 && pixels_per_degree <= 1000.0))
    throw Error("pixels per degree", fmt::format("{}: expected 1 to 1000", pixels_per_degree));
}

DisplayOptions displayFor(const Image& reference, DisplayOptions display) {
  if (display.auto_exposure) display.exposure_stops += autoExposureStops(meanLog2Luminance(reference));
  display.auto_exposure = false;
  return display;
}

double meanOf(const Image& map, const Image& mask) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t pixel = 0; pixel < map.pixelCount(); ++pixel) {
    if (!takes(mask, pixel)) continue;
    sum += double(map.pixels[pixel]);
    ++count;
  }
  return sum / double(count);
}

}  // namespace gloam
