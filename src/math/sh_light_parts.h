// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light in two parts: its sharpest peak as light from one direction, and all the rest. A peak that is much brighter than the rest rings
// below 0 in its own shadow, and takes the other part with it; each part that is kept from falling below 0 by itself does not.
#pragma once

#include <gloam/sh.h>

namespace gloam::sh {

struct LightParts {
  glm::vec3 direction{0.0f, 1.0f, 0.0f};  ///< unit, to the peak; anything where there is none
  glm::vec3 peak{0.0f};  ///< its irradiance on a plane that faces it; 0 where there is no peak
  ShRgb rest;            ///< bands of the light less peak * directionalLight(order, direction)
};

/// Where bands 2 and up are brightest together; as strong, channel by channel, as both highest bands say: a sun is
/// in them as strong as in any other, while what is broad has left them. `light` has four bands or more, else Error; `rest` has
/// `order` of them.
LightParts lightParts(const ShRgb& light, int order);

}  // namespace gloam::sh
