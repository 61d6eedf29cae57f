// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Instant global illumination as it was (Wald et al. 2002), for comparison (RF-6): light shaded at once, by the pixel's own normal
// and lobes. Irradiance, then gloss.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "math/brdf.glsl"
#include "techniques/radiance_filter/radiance_filter_interleaving.glsl"
#include "visibility/visibility_shared.h"
#include "vpls/walks.glsl"

#define GLOAM_VALUES (4 * kLobeLayers)
layout(scalar, push_constant) uniform Push { GatherParams gather; } push;
layout(scalar, set = 0, binding = 7) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 8) uniform usampler2D normals;
layout(set = 0, binding = 9) uniform sampler2D diffuse;

vec3 shading_normal, mirror;
float exponent;

void prepare(ivec2 pixel, SightPoint point) {
  shading_normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
  mirror = mirrorDirection(shading_normal, directionToEye(frame_view.view, point.position));
  exponent = phongExponent(texelFetch(diffuse, pixel, 0).a);
}

void addLight(inout float sum[GLOAM_VALUES], vec3 light, vec3 to_light) {
  vec3 irradiance = light * max(dot(shading_normal, to_light), 0.0), gloss = light * phongLobe(exponent, mirror, to_light);
  sum[0] += irradiance.r;
  sum[1] += irradiance.g;
  sum[2] += irradiance.b;
  sum[3] += gloss.r;
  sum[4] += gloss.g;
  sum[5] += gloss.b;
}

#include "techniques/radiance_filter/radiance_filter_gather.glsl"
