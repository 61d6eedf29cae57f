// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Distant light in two parts, each through the same visibility and kept from falling below 0 by itself: a sun that rings in its
// own shadow no longer takes the sky's light with it. light_peak.glsl is the other half.
#pragma once

#include "frame/light_peak_shared.h"
#include "math/sh_light_parts.h"

namespace gloam::frame {

inline LightPeak lightPeak(const sh::LightParts& parts) {
  LightPeak row{parts.direction, parts.peak, {}};
  const sh::Sh basis = sh::evaluate(4, parts.direction);
  for (int i = 0; i < 16; ++i) row.basis[i] = basis[i];
  return row;
}

}  // namespace gloam::frame
