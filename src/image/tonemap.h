// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// From linear radiance to a display's light. The same functions under the same names: tonemap.glsl.
//
// Filmic curve: Stephen Hill's fit of the Academy's reference rendering and output transforms for Rec. 709
// displays (ACES.hlsl in "BakingLab", Neubelt and Pettineo 2016). Ours differs in one number: the input is
// scaled so that middle grey, 0.18, stays where it is; unscaled it becomes 0.106. Automatic exposure:
// log-average luminance, Reinhard, Stark, Shirley, Ferwerda 2002, equation 1.
#pragma once

#include <gloam/image.h>

#include <cmath>
#include <glm/glm.hpp>

namespace gloam {

inline constexpr float kMiddleGrey = 0.18f;
inline constexpr float kFilmicScale = 1.46193f;  ///< filmicCurve(kMiddleGrey * kFilmicScale) = kMiddleGrey
/// Pixels darker than this are background to automatic exposure.
inline constexpr float kLeastLuminance = 1e-6f;

/// Rec. 709 luminance.
inline float luminance(const glm::vec3& color) {
  return glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

/// One channel, 0 to 1, linear light to the sRGB signal (IEC 61966-2-1).
inline float srgbEncode(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}
inline glm::vec3 srgbEncode(const glm::vec3& linear) {
  return {srgbEncode(linear.x), srgbEncode(linear.y), srgbEncode(linear.z)};
}

/// The fit itself, one channel of the rendering space: rises from 0 towards 1 / 0.983729.
inline float filmicCurve(float x) {
  return (x * (x + 0.0245786f) - 0.000090537f) / (x * (0.983729f * x + 0.4329510f) + 0.238081f);
}

/// Linear 0 to 1 from linear radiance at least 0. Grey stays grey; bright saturated colours bend towards
/// white.
glm::vec3 filmic(const glm::vec3& radiance);

/// Exposure in stops (factor 2^stops), then the curve, clamped to 0 to 1. Negative and not-a-number become 0.
glm::vec3 toneMap(const glm::vec3& radiance, ToneMap curve, float exposure_stops);

/// Stops that bring a log-average luminance (mean of log2) to middle grey.
inline float autoExposureStops(float mean_log2_luminance) {
  return std::log2(kMiddleGrey) - mean_log2_luminance;
}

/// Mean of log2 luminance over the pixels above kLeastLuminance that are finite and, where there is alpha,
/// covered; middle grey's where there are none. R, G, B (, A) or Y (, A).
float meanLog2Luminance(const Image& radiance);

}  // namespace gloam
