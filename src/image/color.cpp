// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// RGB to XYZ: SMPTE RP 177. Chromatic adaptation: linear Bradford (Lam 1985; ICC.1:2010, annex E).
#include "image/color.h"

namespace gloam {

namespace {

glm::dvec3 xyzOf(const glm::dvec2& xy) {
  return {xy.x / xy.y, 1.0, (1.0 - xy.x - xy.y) / xy.y};
}

bool finite(const glm::dmat3& m) {
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      if (!(std::abs(m[column][row]) < 1e6)) return false;
  return true;
}

}  // namespace

glm::dmat3 xyzFromRgb(const Primaries& primaries) {
  const glm::dmat3 columns(xyzOf(primaries[0]), xyzOf(primaries[1]), xyzOf(primaries[2]));
  const glm::dvec3 luminance = glm::inverse(columns) * xyzOf(primaries[3]);
  return {columns[0] * luminance[0], columns[1] * luminance[1], columns[2] * luminance[2]};
}

glm::mat3 rec709From(const Primaries& primaries) {
  double difference = 0.0;
  for (std::size_t i = 0; i < primaries.size(); ++i)
    difference = glm::max(difference, glm::length(primaries[i] - kRec709[i]));
  if (difference < 0.001) return glm::mat3(1.0f);

  // Rows of the Bradford cone response, written as GLM's columns and transposed.
  const glm::dmat3 cone_from_xyz =
      glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const glm::dvec3 from_white = cone_from_xyz * xyzOf(primaries[3]);
  const glm::dvec3 to_white = cone_from_xyz * xyzOf(kRec709[3]);
  const glm::dvec3 gain = to_white / from_white;
  const glm::dmat3 scale(gain.x, 0, 0, 0, gain.y, 0, 0, 0, gain.z);
  const glm::dmat3 adapt = glm::inverse(cone_from_xyz) * scale * cone_from_xyz;
  const glm::dmat3 result = glm::inverse(xyzFromRgb(kRec709)) * adapt * xyzFromRgb(primaries);
  return finite(result) ? glm::mat3(result) : glm::mat3(0.0f);
}

glm::mat3 rec709FromXyz() {
  return glm::mat3(glm::inverse(xyzFromRgb(kRec709)));
}

}  // namespace gloam
