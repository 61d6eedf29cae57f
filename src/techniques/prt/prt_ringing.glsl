// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_PRT_RINGING_GLSL
#define GLOAM_PRT_RINGING_GLSL
#include "techniques/prt/prt_shared.h"

/// As little of the windowed light as lifts every colour to a share of it. Ringing sends colours below 0 one after the
/// other, which leaves saturated stains in the shadows of a small sun.
vec3 withoutRinging(vec3 sharp, vec3 soft) {
  vec3 lack = kLeastOfDamped * max(soft, vec3(0.0)) - sharp;
  vec3 share = lack / max(soft - sharp, vec3(1e-9));
  return mix(sharp, soft, clamp(max(max(share.r, share.g), share.b), 0.0, 1.0));
}

/// Light in two parts (math/sh_light_parts.h): a sun that rings below 0 in its shadow takes nothing from the sky.
vec3 bothParts(vec3 rest, vec3 peak) { return max(rest, vec3(0.0)) + max(peak, vec3(0.0)); }

#endif
