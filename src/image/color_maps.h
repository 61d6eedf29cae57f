// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Colours for one number.
#pragma once

#include <glm/glm.hpp>

namespace gloam {

// Both take 0 to 1 (what lies outside is clamped) and give linear R, G, B.

/// "magma" of Smith and van der Walt (matplotlib 1.5, CC0), in which FLIP is printed: black, purple, orange, pale yellow.
glm::vec3 magmaColor(float value);
/// Black, blue, green, pale yellow in even steps of lightness, so that it is not taken for a map of FLIP.
glm::vec3 errorColor(float value);

}  // namespace gloam
