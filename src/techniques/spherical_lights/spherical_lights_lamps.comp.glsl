// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light of one lamp, through its shadow map, added to what surface samples have (SL-9).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform LightBlock { LightRow row; } light;
layout(scalar, set = 0, binding = 1) readonly buffer ShadowViews { ShadowView at[]; } shadow_views;  // of this lamp
layout(set = 0, binding = 2) uniform sampler2DArray shadow_maps;
layout(scalar, set = 0, binding = 3) readonly buffer Points { PointRow at[]; } points;
layout(scalar, set = 0, binding = 4) buffer Arriving { vec3 at[]; } arriving;
layout(scalar, push_constant) uniform Push { uint points; } push;

#include "frame/lamp_shadow.glsl"

void main() {
  uint p = gl_GlobalInvocationID.x;
  if (p >= push.points || points.at[p].sends == 0.0) return;
  vec3 to_light;
  vec3 irradiance = lampIrradiance(light.row, points.at[p].position, to_light);
  float cosine = dot(points.at[p].normal, to_light);
  if (cosine > 0.0)
    arriving.at[p] += irradiance * cosine * lampShadow(points.at[p].position, points.at[p].normal) / 3.14159265;
}
