// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// REF-2: pictures of a difference, for people.
#include <gloam/metrics.h>

#include <algorithm>
#include <cmath>

#include "image/color.h"
#include "image/color_maps.h"
#include "image/comparison.h"
#include "image/tonemap.h"

namespace gloam {
namespace {

void put(Image& image, std::size_t pixel, const glm::vec3& color) {
  for (int c = 0; c < 3; ++c) image.pixels[pixel * 3 + std::size_t(c)] = color[c];
}

/// The channel that R, G or B of a picture is: a grey one has all three in one.
std::size_t place(const Image& image, std::size_t pixel, int color) {
  return pixel * std::size_t(image.channels) + std::size_t(image.channels >= 3 ? color : 0);
}

/// What `encode` makes of the difference of the two signals, in each channel.
template <class Encode>
Image ofSignals(const Image& a, const Image& reference, const DisplayOptions& display, const Encode& encode) {
  requireComparable(a, reference);
  const DisplayOptions held = displayFor(reference, display);
  const Image shown_a = toneMapped(a, held), shown_b = toneMapped(reference, held);
  Image picture(a.width, a.height, 3);
  for (std::size_t pixel = 0; pixel < picture.pixelCount(); ++pixel) {
    glm::vec3 color;
    for (int c = 0; c < 3; ++c) {
      const std::size_t i = place(a, pixel, c);
      const float difference = srgbEncode(shown_a.pixels[i]) - srgbEncode(shown_b.pixels[i]);
      color[c] = srgbDecode(std::clamp(encode(difference), 0.0f, 1.0f));
    }
    put(picture, pixel, color);
  }
  return picture;
}

}  // namespace

Image absoluteDifferencePicture(const Image& a, const Image& reference, double factor,
                                const DisplayOptions& display) {
  return ofSignals(a, reference, display, [=](float d) { return float(factor) * std::abs(d); });
}

Image differencePicture(const Image& a, const Image& reference, double factor,
                        const DisplayOptions& display) {
  return ofSignals(a, reference, display, [=](float d) { return 0.5f + 0.5f * float(factor) * d; });
}

Image falseColor(const Image& a, const Image& reference, double top) {
  requireComparable(a, reference);
  if (!(top > 0.0 && std::isfinite(top))) throw Error("false color", "a top above 0 was expected");
  double sum = 0.0;
  for (std::size_t pixel = 0; pixel < a.pixelCount(); ++pixel)
    for (int c = 0; c < 3; ++c) sum += double(reference.pixels[place(reference, pixel, c)]);
  const double mean = sum > 0.0 ? sum / double(a.pixelCount()) : 1.0;
  Image picture(a.width, a.height, 3);
  for (std::size_t pixel = 0; pixel < picture.pixelCount(); ++pixel) {
    double difference = 0.0;
    for (int c = 0; c < 3; ++c) {
      const std::size_t i = place(a, pixel, c);
      difference += std::abs(double(a.pixels[i]) - double(reference.pixels[i]));
    }
    put(picture, pixel, errorColor(float(std::min(1.0, difference / (mean * top)))));
  }
  return picture;
}

Image magma(const Image& map) {
  if (map.channels != 1) throw Error("a map of one channel was expected");
  Image picture(map.width, map.height, 3);
  for (std::size_t pixel = 0; pixel < map.pixelCount(); ++pixel)
    put(picture, pixel, magmaColor(map.pixels[pixel]));
  return picture;
}

}  // namespace gloam
