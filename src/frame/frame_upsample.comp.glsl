// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// From coarse receivers to all pixels along surfaces (row PX-8; Sloan, Govindaraju, Nowrouzezahrai, Snyder
// 2007): weights bilinear * max(0, N_p.N_i)^32 / (eps + |z_p - z_i|), normalised. Where none of the four fits
// (a thin thing between coarse samples), the one of the 4 x 4 around whose normal and depth fit best is taken
// as it is.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform sampler2D receiver_normal;  // w: depth along the axis, 0: background
layout(set = 0, binding = 4) uniform sampler2D coarse;
layout(set = 0, binding = 5) uniform writeonly image2D full;
layout(scalar, push_constant) uniform Push { uint divisor; } push;

/// Relative to the pixel's own depth: differences below it count alike.
const float kDepthTolerance = 2e-3;
const float kPoorFit = 0.05;

/// How well a coarse sample stands for the pixel, 0 to 1.
float fitness(ivec2 place, vec3 normal, float along) {
  vec4 sample_ = texelFetch(receiver_normal, place, 0);
  if (sample_.w <= 0.0) return 0.0;
  float epsilon = kDepthTolerance * along;
  return pow(max(0.0, dot(normal, sample_.xyz)), 32.0) * epsilon / (epsilon + abs(along - sample_.w));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(full)))) return;
  float d = texelFetch(depth, pixel, 0).x;
  if (d <= 0.0) {
    imageStore(full, pixel, vec4(0.0));
    return;
  }
  float along = eyeDepth(frame_view.view, d);
  vec3 normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
  ivec2 last = textureSize(coarse, 0) - 1;
  // Coarse samples stand at the middle pixel of their block (frame_receivers).
  vec2 at = (vec2(pixel) - float(push.divisor / 2u)) / float(push.divisor);
  ivec2 base = ivec2(floor(at));
  vec2 f = at - vec2(base);
  vec4 sum = vec4(0.0);
  float total = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    ivec2 place = clamp(base + corner, ivec2(0), last);
    vec2 bilinear = mix(1.0 - f, f, vec2(corner));
    float weight = max(bilinear.x * bilinear.y, 1e-3) * fitness(place, normal, along);
    sum += weight * texelFetch(coarse, place, 0);
    total += weight;
  }
  if (total < kPoorFit) {
    float best = -1.0;
    for (int i = 0; i < 16; ++i) {
      ivec2 place = clamp(base + ivec2(i & 3, i >> 2) - 1, ivec2(0), last);
      float fit = fitness(place, normal, along);
      if (fit <= best) continue;
      best = fit;
      sum = texelFetch(coarse, place, 0);
      total = 1.0;
    }
  }
  imageStore(full, pixel, sum / total);
}
