// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light of the environment through the unshadowed Phong lobe (row RF-5 over order-6 SH), from the table that
// frame/environment_light.cpp makes.
#ifndef GLOAM_FRAME_GLOSS_GLSL
#define GLOAM_FRAME_GLOSS_GLSL
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"

vec3 environmentGloss(sampler3D table, vec3 mirror, float exponent) {
  vec2 place = octahedralPlace(mirror) * 0.5 + 0.5;
  float step_ = clamp(log2(exponent) / log2(kSharpestGloss), 0.0, 1.0);
  vec3 at = vec3((place * float(kGlossSize) + 1.0) / float(kGlossSize + 2),
                 (step_ * float(kGlossSlices - 1) + 0.5) / float(kGlossSlices));
  return textureLod(table, at, 0.0).rgb;
}

#endif
