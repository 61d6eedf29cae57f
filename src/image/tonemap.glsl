// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The functions of src/image/tonemap.h; sources and differences stand there. A test compiles this file as C++
// (hence the f behind numbers) and compares.
#ifndef GLOAM_IMAGE_TONEMAP_GLSL
#define GLOAM_IMAGE_TONEMAP_GLSL

const float kMiddleGrey = 0.18f;
const float kFilmicScale = 1.46193f;
const float kLeastLuminance = 1e-6f;
const uint kToneMapNone = 0u, kToneMapAces = 1u;

float luminance(vec3 color) { return dot(color, vec3(0.2126f, 0.7152f, 0.0722f)); }

vec3 srgbEncode(vec3 linear) {
  vec3 low = 12.92f * linear;
  vec3 high = 1.055f * pow(max(linear, vec3(0.0031308f)), vec3(1.0f / 2.4f)) - 0.055f;
  return mix(high, low, vec3(lessThanEqual(linear, vec3(0.0031308f))));
}

vec3 filmicCurve(vec3 x) {
  return (x * (x + 0.0245786f) - 0.000090537f) / (x * (0.983729f * x + 0.4329510f) + 0.238081f);
}

vec3 filmic(vec3 radiance) {
  const mat3 rendering_from_rec709 = mat3(0.59719f, 0.07600f, 0.02840f, 0.35458f, 0.90834f, 0.13383f, 0.04823f, 0.01566f, 0.83777f);
  const mat3 rec709_from_rendering = mat3(1.60475f, -0.10208f, -0.00327f, -0.53108f, 1.10813f, -0.07276f, -0.07367f, -0.00605f, 1.07602f);
  return rec709_from_rendering * filmicCurve(rendering_from_rec709 * (kFilmicScale * radiance));
}

vec3 toneMap(vec3 radiance, uint curve, float exposure_stops) {
  // Beyond this the curve is flat, and its square would overflow.
  vec3 exposed = radiance * exp2(exposure_stops);
  exposed = mix(clamp(exposed, vec3(0.0f), vec3(1e6f)), vec3(0.0f), isnan(exposed));
  vec3 mapped = curve == kToneMapAces ? filmic(exposed) : exposed;
  return clamp(mapped, vec3(0.0f), vec3(1.0f));
}

float autoExposureStops(float mean_log2_luminance) { return log2(kMiddleGrey) - mean_log2_luminance; }

#endif
