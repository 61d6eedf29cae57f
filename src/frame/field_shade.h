// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Distant light through a visibility field: what techniques that sum logs of spheres share. field_shade.glsl is its other half.
#pragma once

#include <gloam/sh.h>

namespace gloam::frame {

/// Bands of a visibility field.
inline constexpr int kFieldOrder = 4;

/// Q[9 i + j] (144 of them): irradiance through a visibility O at a normal N = sum of O_i Q_ij y_j(N). `light` has four
/// bands, windowed or not.
void shadeRows(const sh::ShRgb& light, glm::vec3 rows[144]);

/// Coefficients about +Z times sqrt(4 pi / (2 l + 1)): bands of y(axis) times these are the function about that axis (SH-4).
glm::vec4 bandFactors(const sh::Zh& zonal);

}  // namespace gloam::frame
