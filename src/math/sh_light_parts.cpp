// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// After Sloan 2008, "Stupid Spherical Harmonics (SH) Tricks", "Extracting Dominant Light": a directional light by least squares over
// all bands. Differs: its direction is that of the sharpest peak, not of the linear band, which a bright sky turns away from a low
// sun; and its strength is what the two highest bands say, since in the lower ones a sky counts as well.
#include "math/sh_light_parts.h"

#include <algorithm>
#include <string>

#include "math/sh_check.h"

namespace gloam::sh {

LightParts lightParts(const ShRgb& light, int order) {
  checkOrder(order);
  constexpr int kFewest = 4, kUsed = 2;
  if (light.order < kFewest)
    throw Error("light in parts", std::to_string(light.order) + " bands, expected at least 4");
  // Sharpened as by the Laplacian, upside down, since minima are what is searched.
  Sh sharp(light.order);
  for (int l = 2; l < light.order; ++l) {
    for (int i = l * l; i < (l + 1) * (l + 1); ++i)
      sharp[i] = -float(l * (l + 1)) * (light[i].r + light[i].g + light[i].b);
  }
  LightParts parts;
  parts.direction = minimum(sharp).direction;
  const Sh there = evaluate(light.order, parts.direction);
  float norm = 0.0f;
  for (int i = (light.order - kUsed) * (light.order - kUsed); i < light.size(); ++i) {
    parts.peak += light[i] * there[i];
    norm += there[i] * there[i];
  }
  parts.peak = glm::max(parts.peak / norm, glm::vec3(0.0f));
  parts.rest = truncated(light, order);
  for (int i = 0; i < std::min(order, light.order) * std::min(order, light.order); ++i)
    parts.rest[i] -= parts.peak * there[i];
  return parts;
}

}  // namespace gloam::sh
