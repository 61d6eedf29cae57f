// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SplatParams, member by member, as proxies_gather.glsl reads push.params.
#ifndef GLOAM_PROXIES_SPLAT_PUSH_GLSL
#define GLOAM_PROXIES_SPLAT_PUSH_GLSL

layout(scalar, push_constant) uniform Push {
  AccumulateParams params;
  uint columns;
  uint rows;
  uint divisor;
} push;

#endif
