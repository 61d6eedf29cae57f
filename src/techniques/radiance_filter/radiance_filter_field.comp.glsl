// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// RF-3: L_lm = sum over the set of light_k V_k y_lm(w_k), in three bands; no receiver cosine, no shading normal.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "math/sh.glsl"
#include "techniques/radiance_filter/radiance_filter_interleaving.glsl"
#include "visibility/visibility_shared.h"
#include "vpls/walks.glsl"

#define GLOAM_VALUES (4 * kFieldLayers)
layout(scalar, push_constant) uniform Push { GatherParams gather; } push;

void prepare(ivec2 pixel, SightPoint point) {}

void addLight(inout float sum[GLOAM_VALUES], vec3 light, vec3 to_light) {
  float y[9];
  shEvaluate3(to_light, y);
  for (int i = 0; i < 9; ++i) {
    sum[3 * i] += light.r * y[i];
    sum[3 * i + 1] += light.g * y[i];
    sum[3 * i + 2] += light.b * y[i];
  }
}

#include "techniques/radiance_filter/radiance_filter_gather.glsl"
