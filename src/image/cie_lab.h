// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// CIE 1976 L*a*b* (CIE 15:2004, section 8.2.1) of linear Rec. 709, relative to its white. X, Y and Z are fractions of
// the white's here, so that grey has three equal ones.
#pragma once

#include <bit>
#include <cstdint>
#include <glm/glm.hpp>

#include "image/color.h"

namespace gloam {

/// Rows of a 3x3 matrix as plain numbers: loops over pixels keep them in registers.
struct ColorMatrix {
  float m[3][3];
};

/// X/Xn, Y/Yn, Z/Zn from R, G, B, or back.
inline ColorMatrix relativeXyzFromRec709(bool inverse = false) {
  const glm::dmat3 xyz = xyzFromRgb(kRec709);
  const glm::dvec3 white = xyz * glm::dvec3(1.0);
  glm::dmat3 relative;
  for (int column = 0; column < 3; ++column) relative[column] = xyz[column] / white;
  if (inverse) relative = glm::inverse(relative);
  ColorMatrix result;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) result.m[row][column] = float(relative[column][row]);
  return result;
}

/// The cube root of a number above 0, within 3 units in the last place: a third of the exponent, then Halley's rule
/// twice. Without a branch, so that loops become SIMD.
inline float cubeRoot(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  float root = std::bit_cast<float>(std::int32_t(float(bits) * (1.0f / 3.0f)) + 709921077);
  const auto halley = [x](float r) { return r * (r * r * r + 2.0f * x) / (2.0f * r * r * r + x); };
  return halley(halley(root));
}

/// The compressed fraction of white that L*, a* and b* are differences of.
inline float labCurve(float fraction) {
  constexpr float kKnee = 216.0f / 24389.0f;  // (6/29)^3
  const float line = fraction * (841.0f / 108.0f) + 4.0f / 29.0f;
  const float root = cubeRoot(fraction < kKnee ? kKnee : fraction);
  return fraction < kKnee ? line : root;
}
inline float labCurveInverse(float value) {
  return value > 6.0f / 29.0f ? value * value * value : (value - 4.0f / 29.0f) * (108.0f / 841.0f);
}

/// Linear Rec. 709 of L*, a*, b*; outside 0 to 1 where a display has no such colour.
inline glm::vec3 rec709FromLab(const glm::vec3& lab) {
  static const ColorMatrix kRgb = relativeXyzFromRec709(true);
  const float fy = (lab.x + 16.0f) / 116.0f;
  const float xyz[] = {labCurveInverse(fy + lab.y / 500.0f), labCurveInverse(fy),
                       labCurveInverse(fy - lab.z / 200.0f)};
  glm::vec3 rgb(0.0f);
  for (int row = 0; row < 3; ++row)
    for (int k = 0; k < 3; ++k) rgb[row] += kRgb.m[row][k] * xyz[k];
  return rgb;
}

}  // namespace gloam
