// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// errorColor is a curve in CIE L*a*b*: lightness proportional to the value, hue falling from blue to yellow, chroma as
// wide as colours of a display allow along the way.
#include "image/color_maps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "image/cie_lab.h"

namespace gloam {

glm::vec3 magmaColor(float value) {
  // Every 17th of the 256 colours, sRGB; straight lines between them are within 3 of 255.
  static constexpr std::array<unsigned, 16> kColors = {
      0x000004, 0x0b0924, 0x20114b, 0x3b0f70, 0x57157e, 0x721f81, 0x8c2981, 0xa8327d,
      0xc43c75, 0xde4968, 0xf1605d, 0xfa7f5e, 0xfe9f6d, 0xfebf84, 0xfddea0, 0xfcfdbf};
  const float place = std::clamp(value, 0.0f, 1.0f) * float(kColors.size() - 1);
  const std::size_t below = std::min(std::size_t(place), kColors.size() - 2);
  const float part = place - float(below);
  glm::vec3 color;
  for (int c = 0; c < 3; ++c) {
    const auto channel = [&](std::size_t i) { return float((kColors[i] >> (16 - 8 * c)) & 255u) / 255.0f; };
    color[c] = srgbDecode((1.0f - part) * channel(below) + part * channel(below + 1));
  }
  return color;
}

glm::vec3 errorColor(float value) {
  struct Knot {
    float value, hue_degrees, chroma;
  };
  static constexpr std::array<Knot, 5> kKnots = {{{0.0f, 295.0f, 0.0f},
                                                  {0.1f, 280.0f, 19.0f},
                                                  {0.5f, 200.0f, 28.0f},
                                                  {0.85f, 125.0f, 66.0f},
                                                  {1.0f, 105.0f, 34.0f}}};
  const float t = std::clamp(value, 0.0f, 1.0f);
  std::size_t next = 1;
  while (next + 1 < kKnots.size() && t > kKnots[next].value) ++next;
  const Knot &from = kKnots[next - 1], &to = kKnots[next];
  const float part = (t - from.value) / (to.value - from.value);
  const float hue = glm::radians(std::lerp(from.hue_degrees, to.hue_degrees, part));
  const float chroma = std::lerp(from.chroma, to.chroma, part);
  const glm::vec3 rgb = rec709FromLab({96.0f * t, chroma * std::cos(hue), chroma * std::sin(hue)});
  return glm::clamp(rgb, 0.0f, 1.0f);
}

}  // namespace gloam
