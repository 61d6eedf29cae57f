// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// From coarse receivers to all pixels along surfaces (row PX-8; Sloan, Govindaraju, Nowrouzezahrai, Snyder
// 2007): weights bilinear * max(0, N_p.N_i)^32 / (eps + |z_p - z_i|), normalised (upsample.glsl). Where none of the four fits
// (a thin thing between coarse samples), the one of the 4 x 4 around whose normal and depth fit best is taken
// as it is.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/upsample.glsl"
#include "frame/view.glsl"

layout(constant_id = 0) const bool along_surfaces = true;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform sampler2D receiver_normal;  // w: depth along the axis, 0: background
layout(set = 0, binding = 4) uniform sampler2D coarse;
layout(set = 0, binding = 5) uniform writeonly image2D full;
layout(scalar, push_constant) uniform Push { uint divisor; } push;

/// How well a coarse sample stands for the pixel, 0 to 1; `at`: the pixel's place among them.
float fitness(ivec2 place, vec2 at, vec3 normal, PixelPlane plane) {
  if (!along_surfaces) return 1.0;
  vec4 receiver = texelFetch(receiver_normal, place, 0);
  receiver.w = evenDepth(frame_view.view, receiver.w);
  return receiverFitness(receiver, normal, plane, (vec2(place) - at) * float(push.divisor));
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
  uvec2 packed = texelFetch(normals, pixel, 0).xy;
  vec3 normal = shadingNormal(packed);
  PixelPlane plane = pixelPlane(frame_view.view, pixel, along, geometricNormal(packed));
  ivec2 last = textureSize(coarse, 0) - 1;
  vec2 at = receiverPlace(pixel, push.divisor);
  ivec2 base = ivec2(floor(at));
  vec2 f = at - vec2(base);
  vec4 sum = vec4(0.0);
  float total = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    ivec2 place = clamp(base + corner, ivec2(0), last);
    vec2 bilinear = mix(1.0 - f, f, vec2(corner));
    float weight = max(bilinear.x * bilinear.y, kLeastBilinear) * fitness(place, at, normal, plane);
    sum += weight * texelFetch(coarse, place, 0);
    total += weight;
  }
  if (total < kPoorFit) {
    float best = -1.0;
    for (int i = 0; i < 16; ++i) {
      ivec2 place = clamp(base + ivec2(i & 3, i >> 2) - 1, ivec2(0), last);
      float fit = fitness(place, at, normal, plane);
      if (fit <= best) continue;
      best = fit;
      sum = texelFetch(coarse, place, 0);
      total = 1.0;
    }
  }
  imageStore(full, pixel, sum / total);
}
