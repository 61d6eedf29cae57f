// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#ifndef GLOAM_VPLS_WALKS_SHARED_H
#define GLOAM_VPLS_WALKS_SHARED_H
#include "visibility/visibility_shared.h"
GLOAM_SHARED_BEGIN(vpls)
#ifdef __cplusplus
using visibility::SightEnd;
#endif

/// A light of a lit surface shines as from a disc of half its bound, square metres over pi, where it is near to what it lights: points
/// beside it, and low over its plane, get what a bound alone takes from them (RF-9). Lower than a quarter of the disc's radius light fades.
GLOAM_SHARED_CONST float kDiscReach = 0.5f;
GLOAM_SHARED_CONST float kDiscSoftness = 0.0625f;

/// A light of a set (RF-1). What end.kind says, and what `light` is then:
///   kSightLamp         a point or spot light; candela. Axis (the way it shines) in end.normal
///   kSightDirectional  a direction of the environment, or a directional lamp; irradiance on a plane that faces it
///   kSightBothSides    a point of a surface that glows; W/sr along the normal, to either side
///   kSightSurface      a point of a surface that is lit; W/sr along the normal: flux / pi
/// vpls/walks.glsl evaluates any of them.
struct WalkVpl {
  SightEnd end;
  vec3 light;
  float bound;      // square metres; surfaces: nearer than its square root counts as that near
  float cos_inner;  // kSightLamp; -1 and -2: a point light
  float cos_outer;
  float range;  // 0: unlimited
  uint bounce;  // 0: a source itself (direct light); 1: a surface that sources light, 2, …
};
GLOAM_SHARED_SIZE(WalkVpl, 64)

GLOAM_SHARED_END
#endif
