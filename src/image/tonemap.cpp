// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sources and what differs: tonemap.h.
#include "image/tonemap.h"

#include <fmt/format.h>

namespace gloam {

glm::vec3 filmic(const glm::vec3& radiance) {
  // Columns. From Rec. 709 to the space of the rendering transform (its desaturation included), and back.
  const glm::mat3 rendering_from_rec709(0.59719f, 0.07600f, 0.02840f, 0.35458f, 0.90834f, 0.13383f, 0.04823f,
                                        0.01566f, 0.83777f);
  const glm::mat3 rec709_from_rendering(1.60475f, -0.10208f, -0.00327f, -0.53108f, 1.10813f, -0.07276f,
                                        -0.07367f, -0.00605f, 1.07602f);
  const glm::vec3 x = rendering_from_rec709 * (kFilmicScale * radiance);
  return rec709_from_rendering * glm::vec3(filmicCurve(x.r), filmicCurve(x.g), filmicCurve(x.b));
}

glm::vec3 toneMap(const glm::vec3& radiance, ToneMap curve, float exposure_stops) {
  // Beyond 1e6 the curve is flat, and its square would overflow.
  glm::vec3 exposed = radiance * std::exp2(exposure_stops);
  for (int c = 0; c < 3; ++c) exposed[c] = exposed[c] > 0.0f ? std::min(exposed[c], 1e6f) : 0.0f;
  return glm::clamp(curve == ToneMap::kAces ? filmic(exposed) : exposed, 0.0f, 1.0f);
}

namespace {

glm::vec3 colorOf(const Image& image, std::size_t pixel) {
  const float* p = &image.pixels[pixel * std::size_t(image.channels)];
  return image.channels >= 3 ? glm::vec3(p[0], p[1], p[2]) : glm::vec3(p[0]);
}

}  // namespace

float meanLog2Luminance(const Image& radiance) {
  const bool alpha = radiance.channels == 2 || radiance.channels == 4;
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < radiance.pixelCount(); ++i) {
    const float y = luminance(colorOf(radiance, i));
    if (!(y > kLeastLuminance) || !std::isfinite(y)) continue;
    if (alpha && !(radiance.pixels[(i + 1) * std::size_t(radiance.channels) - 1] > 0.0f)) continue;
    sum += std::log2(y);
    ++count;
  }
  return count == 0 ? std::log2(kMiddleGrey) : static_cast<float>(sum / double(count));
}

Image toneMapped(const Image& radiance, const DisplayOptions& options) {
  float stops = options.exposure_stops;
  if (options.auto_exposure) stops += autoExposureStops(meanLog2Luminance(radiance));
  Image result = radiance;
  const int color_channels = radiance.channels >= 3 ? 3 : 1;
  for (std::size_t i = 0; i < result.pixelCount(); ++i) {
    const glm::vec3 mapped = toneMap(colorOf(radiance, i), options.tone_map, stops);
    for (int c = 0; c < color_channels; ++c)
      result.pixels[i * std::size_t(result.channels) + std::size_t(c)] = mapped[c];
  }
  return result;
}

}  // namespace gloam
