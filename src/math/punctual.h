// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How the light of a lamp falls off, as KHR_lights_punctual defines it. The reference and all techniques use
// this; shaders have the same functions in math/punctual.glsl.
//
// Irradiance on a plane that faces the lamp at distance d: intensity * rangeFactor / d^2 * coneFactor.
// Directional lights: the intensity itself.
#pragma once

#include <algorithm>
#include <cmath>

namespace gloam::punctual {

/// Squared distances below this count as this: 1 / d^2 stays finite inside a lamp.
inline constexpr float kLeastSquaredDistance = 1e-8f;

/// max(0, min(1, 1 - (d / range)^4)); 1 where the range is 0 (unlimited).
inline float rangeFactor(float distance, float range) {
  if (range <= 0.0f) return 1.0f;
  const float ratio = distance / range;
  return std::clamp(1.0f - ratio * ratio * ratio * ratio, 0.0f, 1.0f);
}

/// 1 within the inner cone, 0 outside the outer one, a squared ramp over the cosine between.
inline float coneFactor(float cos_angle, float cos_inner, float cos_outer) {
  const float ramp = (cos_angle - cos_outer) / std::max(1e-3f, cos_inner - cos_outer);
  const float clamped = std::clamp(ramp, 0.0f, 1.0f);
  return clamped * clamped;
}

}  // namespace gloam::punctual
