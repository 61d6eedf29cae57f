// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Direct light of one lamp, added to that of the others: E = intensity * rangeFactor / d^2 * coneFactor on a
// plane that faces the lamp, times the lobes, times the shadow map. A lamp behind the geometric surface gives
// nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "math/brdf.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(scalar, set = 0, binding = 1) uniform LightBlock { LightRow row; } light;
layout(scalar, set = 0, binding = 2) readonly buffer ShadowViews { ShadowView at[]; } shadow_views;  // of this lamp
layout(set = 0, binding = 3) uniform sampler2DArray shadow_maps;
layout(set = 0, binding = 4) uniform sampler2D depth;
layout(set = 0, binding = 5) uniform usampler2D normals;
layout(set = 0, binding = 6) uniform sampler2D diffuse;
layout(set = 0, binding = 7) uniform sampler2D specular;
layout(set = 0, binding = 8, rgba32f) uniform image2D local_light;
layout(constant_id = 0) const bool first = true;  // nothing to add to yet

#include "frame/lamp_shadow.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(local_light)))) return;
  vec3 sum = first ? vec3(0.0) : imageLoad(local_light, pixel).rgb;
  float d = texelFetch(depth, pixel, 0).x;
  if (d > 0.0) {
    Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
    vec3 position = ray.origin + ray.direction * eyeDepth(frame_view.view, d);
    uvec2 packed_normals = texelFetch(normals, pixel, 0).xy;
    vec3 geometric = geometricNormal(packed_normals);
    vec3 to_light;
    vec3 irradiance = lampIrradiance(light.row, position, to_light);
    if (dot(geometric, to_light) > 0.0) {
      vec4 kd = texelFetch(diffuse, pixel, 0);
      Lobes lobes = Lobes(kd.rgb, texelFetch(specular, pixel, 0).rgb, phongExponent(kd.a));
      vec3 to_eye = directionToEye(frame_view.view, position);
      sum += irradiance * evaluateLobes(lobes, shadingNormal(packed_normals), to_eye, to_light) *
             lampShadow(position, geometric);
    }
  }
  imageStore(local_light, pixel, vec4(sum, 0.0));
}
