// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Direct light of lamps: E = intensity * rangeFactor / d^2 * coneFactor on a plane that faces the lamp, times the lobes, times
// the shadow map. Lamps behind the geometric surface give nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/shadow.glsl"
#include "frame/view.glsl"
#include "math/brdf.glsl"
#include "math/punctual.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(scalar, set = 0, binding = 1) readonly buffer Lights { LightRow at[]; } lights;
layout(scalar, set = 0, binding = 2) readonly buffer ShadowViews { ShadowView at[]; } shadow_views;
layout(set = 0, binding = 3) uniform sampler2DArray shadow_maps;
layout(set = 0, binding = 4) uniform sampler2D depth;
layout(set = 0, binding = 5) uniform usampler2D normals;
layout(set = 0, binding = 6) uniform sampler2D diffuse;
layout(set = 0, binding = 7) uniform sampler2D specular;
layout(set = 0, binding = 8) uniform writeonly image2D local_light;
layout(scalar, push_constant) uniform Push { uint light_count; } push;

/// Irradiance on a plane that faces the lamp, and the direction to it.
vec3 lampIrradiance(LightRow light, vec3 position, out vec3 to_light) {
  if (light.kind == kLightDirectional) {
    to_light = -light.direction;
    return light.intensity;
  }
  vec3 between = light.position - position;
  float squared = max(dot(between, between), kLeastSquaredDistance);
  float distance = sqrt(squared);
  to_light = between / distance;
  float factor = rangeFactor(distance, light.range) / squared;
  if (light.kind == kLightSpot) factor *= coneFactor(-dot(to_light, light.direction), light.cos_inner, light.cos_outer);
  return light.intensity * factor;
}

float lampShadow(LightRow light, vec3 position, vec3 geometric_normal) {
  if (light.map_count == 0u) return 1.0;
  uint layer = light.first_map + (light.map_count == 6u ? cubeFace(position - light.position) : 0u);
  return shadowFactor(shadow_views.at[layer], shadow_maps, int(layer), position, geometric_normal);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(local_light)))) return;
  vec3 sum = vec3(0.0);
  float d = texelFetch(depth, pixel, 0).x;
  if (d > 0.0) {
    Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
    vec3 position = ray.origin + ray.direction * eyeDepth(frame_view.view, d);
    vec3 to_eye = directionToEye(frame_view.view, position);
    uvec2 packed_normals = texelFetch(normals, pixel, 0).xy;
    vec3 shading = shadingNormal(packed_normals), geometric = geometricNormal(packed_normals);
    vec4 kd = texelFetch(diffuse, pixel, 0);
    Lobes lobes = Lobes(kd.rgb, texelFetch(specular, pixel, 0).rgb, phongExponent(kd.a));
    for (uint i = 0u; i < push.light_count; ++i) {
      vec3 to_light;
      vec3 irradiance = lampIrradiance(lights.at[i], position, to_light);
      if (dot(geometric, to_light) <= 0.0 || irradiance == vec3(0.0)) continue;
      vec3 radiance = irradiance * evaluateLobes(lobes, shading, to_eye, to_light);
      if (radiance == vec3(0.0)) continue;
      sum += radiance * lampShadow(lights.at[i], position, geometric);
    }
  }
  imageStore(local_light, pixel, vec4(min(sum, vec3(65504.0)), 0.0));
}
