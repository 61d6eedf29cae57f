// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Angles in turns, as random numbers and pictures of the sky have them, without calls into the mathematics library: a path
// asks for a dozen of them between two rays. Polynomials through Chebyshev nodes; errors below 1e-7.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace gloam::reference::angles {

/// Angle of (x, y) in turns, -1/2 to 1/2: atan2(y, x) / 2 pi. 0 for (0, 0).
inline float turns(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float high = std::max(std::max(ax, ay), 1e-37f), t = std::min(ax, ay) / high, s = t * t;
  float angle =
      t * (0.15915492f +
           s * (-0.05304923f +
                s * (0.03177841f +
                     s * (-0.02228693f +
                          s * (0.01570679f + s * (-0.00936305f + s * (0.00378479f + s * -0.00072571f)))))));
  angle = ay > ax ? 0.25f - angle : angle;
  angle = x < 0.0f ? 0.5f - angle : angle;
  return std::copysign(angle, y);
}

/// sin(2 pi t) for t between -1/4 and 1/4.
inline float quarterSine(float t) {
  const float s = t * t;
  return t * (6.28318528f + s * (-41.3416806f + s * (81.6024764f + s * (-76.5811726f + s * 39.7598271f))));
}

struct Circle {
  float cosine, sine;
};
/// Of an angle between -1 and 1 turns.
inline Circle circle(float turns) {
  const float t = turns - (turns >= 0.5f ? 1.0f : 0.0f) + (turns < -0.5f ? 1.0f : 0.0f), size = std::abs(t);
  return {quarterSine(0.25f - size), std::copysign(quarterSine(0.25f - std::abs(size - 0.25f)), t)};
}

}  // namespace gloam::reference::angles
