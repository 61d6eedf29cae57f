// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Colour spaces of picture files. Everything inside is linear Rec. 709 (IEC 61966-2-1 primaries, white D65).
#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>

namespace gloam {

/// IEC 61966-2-1, 0 to 1 on both sides. Linear below 0.04045 / 12.92.
inline float srgbDecode(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// CIE xy of red, green, blue and white.
using Primaries = std::array<glm::dvec2, 4>;
inline constexpr Primaries kRec709{{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}}};

/// CIE XYZ from RGB: (1, 1, 1) becomes the white of luminance 1. Not finite, or not invertible, for senseless
/// primaries.
glm::dmat3 xyzFromRgb(const Primaries& primaries);

/// Rec. 709 from RGB of other primaries; their white becomes ours (Bradford adaptation), so that grey stays
/// grey. The identity for Rec. 709 itself (within 0.001). All zeros where the primaries make no sense.
glm::mat3 rec709From(const Primaries& primaries);

/// Rec. 709 from absolute CIE XYZ, white D65, no adaptation.
glm::mat3 rec709FromXyz();

}  // namespace gloam
