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
  const float high = std::max(ax, ay), t = high > 0.0f ? std::min(ax, ay) / high : 0.0f, s = t * t;
  float angle =
      t * (0.15915492f +
           s * (-0.05304923f +
                s * (0.03177841f +
                     s * (-0.02228693f +
                          s * (0.01570679f + s * (-0.00936305f + s * (0.00378479f + s * -0.00072571f)))))));
  if (ay > ax) angle = 0.25f - angle;
  if (x < 0.0f) angle = 0.5f - angle;
  return std::copysign(angle, y);
}

struct Circle {
  float cosine, sine;
};
/// Of an angle in turns, of any sign, small enough for floats to tell its fraction.
inline Circle circle(float turns) {
  // Quarters are counted off; what remains is an eighth of a turn at most, to either side.
  const float quarters = std::floor(4.0f * turns + 0.5f);
  const float t = turns - 0.25f * quarters, s = t * t;
  const float sine = t * (6.28318529f + s * (-41.3416626f + s * (81.5925429f + s * -75.4016127f)));
  const float cosine = 0.99999997f + s * (-19.7391521f + s * (64.9212343f + s * -83.5918168f));
  const int quadrant = int(quarters) & 3;
  const float a = (quadrant & 1) != 0 ? sine : cosine, b = (quadrant & 1) != 0 ? cosine : sine;
  return {quadrant == 1 || quadrant == 2 ? -a : a, quadrant >= 2 ? -b : b};
}

/// sampling::frame(axis) * (direction about +Z).
inline glm::vec3 about(const glm::vec3& n, float x, float y, float z) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  return {(1.0f + sign * n.x * n.x * a) * x + b * y + n.x * z,
          sign * b * x + (sign + n.y * n.y * a) * y + n.y * z, -sign * n.x * x - n.y * y + n.z * z};
}

}  // namespace gloam::reference::angles
