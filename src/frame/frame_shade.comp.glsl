// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light becomes colour: emission + lamps + k_d / pi times irradiance + the Phong lobe under the environment's
// order-6 SH (row RF-5: k_s sum of Pi_l(n) L_lm y_lm(R); unshadowed, tabulated), or k_s times what the technique found
// + background.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/gloss.glsl"
#include "frame/view.glsl"
#include "math/brdf.glsl"

layout(constant_id = 0) const bool environment_gloss = true;
layout(constant_id = 1) const bool background = true;
layout(constant_id = 2) const float background_alpha = 1.0;
layout(constant_id = 3) const bool technique_gloss = false;

const float kPi = 3.14159265;
const float kLargestHalf = 65504.0;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(scalar, set = 0, binding = 1) uniform EnvironmentBlock { EnvironmentRow row; } environment;
layout(set = 0, binding = 2) uniform sampler2D environment_map;
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform usampler2D normals;
layout(set = 0, binding = 5) uniform sampler2D diffuse;
layout(set = 0, binding = 6) uniform sampler2D specular;
layout(set = 0, binding = 7) uniform sampler2D emission;
layout(set = 0, binding = 8) uniform sampler2D local_light;
layout(set = 0, binding = 9) uniform sampler2D irradiance_direct;
layout(set = 0, binding = 10) uniform sampler2D irradiance_indirect;
layout(set = 0, binding = 11) uniform writeonly image2D direct;
layout(set = 0, binding = 12) uniform writeonly image2D indirect;
layout(set = 0, binding = 13) uniform sampler3D gloss;
layout(set = 0, binding = 14) uniform sampler2D gloss_direct;
layout(set = 0, binding = 15) uniform sampler2D gloss_indirect;
layout(scalar, set = 0, binding = 16) readonly buffer Discs { DiscRow at[]; } discs;

/// Discs in a direction, antialiased over a pixel's angle; one that is smaller than the pixel keeps its light.
vec3 discRadiance(vec3 d, float pixel_rad) {
  vec3 sum = vec3(0.0);
  for (uint k = 0u; k < environment.row.disc_count; ++k) {
    DiscRow disc = discs.at[k];
    float angle = 2.0 * asin(min(0.5 * length(d - disc.direction), 1.0));
    float width = max(pixel_rad, 1e-5), small = min(2.0 * disc.radius_rad / width, 1.0);
    sum += small * small * clamp((disc.radius_rad - angle) / width + 0.5, 0.0, 1.0) * disc.radiance;
  }
  return sum;
}

/// The environment's picture in a direction; u = atan2(z, x) / 2 pi + 1/2, v = asin(y) / pi + 1/2 with v up.
vec3 backgroundRadiance(Ray ray, vec3 step_y) {
  vec3 d = normalize(ray.direction);
  float c = environment.row.cos_rotation, s = environment.row.sin_rotation;
  vec3 turned = vec3(c * d.x - s * d.z, d.y, s * d.x + c * d.z);
  vec2 uv = vec2(atan(turned.z, turned.x) / (2.0 * kPi) + 0.5, 0.5 - asin(clamp(turned.y, -1.0, 1.0)) / kPi);
  float pixel_rad = length(step_y) / length(ray.direction);
  float texels = pixel_rad * environment.row.map_height / kPi;  // a pixel's height
  return environment.row.intensity * textureLod(environment_map, uv, log2(max(texels, 1.0))).rgb + discRadiance(d, pixel_rad);
}

vec3 fetch(sampler2D image, ivec2 pixel) { return texelFetch(image, min(pixel, textureSize(image, 0) - 1), 0).rgb; }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(direct)))) return;
  FrameView view = frame_view.view;
  Ray ray = pixelRay(view, vec2(pixel) + 0.5);
  float d = texelFetch(depth, pixel, 0).x;
  vec4 first = vec4(0.0, 0.0, 0.0, background_alpha);
  vec3 further = vec3(0.0);
  if (d > 0.0) {
    vec4 kd = texelFetch(diffuse, pixel, 0);
    vec3 over_pi = kd.rgb / kPi;
    first = vec4(texelFetch(emission, pixel, 0).rgb + fetch(local_light, pixel), 1.0);
    first.rgb += over_pi * fetch(irradiance_direct, pixel);
    further = over_pi * fetch(irradiance_indirect, pixel);
    vec3 ks = texelFetch(specular, pixel, 0).rgb;
    if (technique_gloss) {
      first.rgb += ks * fetch(gloss_direct, pixel);
      further += ks * fetch(gloss_indirect, pixel);
    }
    if (environment_gloss) {
      vec3 position = ray.origin + ray.direction * eyeDepth(view, d);
      vec3 normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
      vec3 mirror = mirrorDirection(normal, directionToEye(view, position));
      first.rgb += ks * environmentGloss(gloss, mirror, phongExponent(kd.a));
    }
  } else if (background) {
    first.rgb = backgroundRadiance(ray, view.depth_range > 0.0 ? vec3(0.0) : view.step_y);
  }
  imageStore(direct, pixel, min(first, vec4(kLargestHalf)));
  imageStore(indirect, pixel, vec4(min(further, vec3(kLargestHalf)), 0.0));
}
