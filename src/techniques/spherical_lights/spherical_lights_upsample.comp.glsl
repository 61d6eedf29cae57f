// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-8: both irradiances brought to every pixel along surfaces, all pixels between the same four receivers by one invocation. Pixels that
// these fit badly, or between receivers that disagree (one of them in a crevice), go on a list (spherical_lights_widen).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform sampler2D receiver_normal;  // w: depth along the axis, 0: background
layout(set = 0, binding = 4) uniform sampler2D direct;
layout(set = 0, binding = 5) uniform sampler2D indirect;
layout(scalar, set = 0, binding = 6) buffer Misfits { QuadList list; uint at[]; } misfits;
layout(set = 0, binding = 7) uniform writeonly image2D direct_full;
layout(set = 0, binding = 8) uniform writeonly image2D indirect_full;
layout(scalar, push_constant) uniform Push { uint divisor; uint capacity; } push;

#include "frame/four_receivers.glsl"
#include "techniques/spherical_lights/spherical_lights_disagree.glsl"

void main() {
  int divisor = int(push.divisor);
  ivec2 size = imageSize(direct_full), first = ivec2(gl_GlobalInvocationID.xy) * divisor - divisor / 2;
  if (any(greaterThanEqual(first, size))) return;
  FourReceivers four = fourReceivers(ivec2(gl_GlobalInvocationID.xy));
#define GLOAM_FOUR(image)                                                                                        \
  mat4x3(texelFetch(image, four.p00, 0).rgb, texelFetch(image, four.p10, 0).rgb, texelFetch(image, four.p01, 0).rgb,            \
         texelFetch(image, four.p11, 0).rgb)
  mat4x3 lit = GLOAM_FOUR(direct), sent = GLOAM_FOUR(indirect);
  vec4 bright = brightnessOf(lit) + brightnessOf(sent);
  uint bad = 0u;  // of a square of 2 x 2 pixels; with kQuadFlag if in a crease
  for (int i = 0; i < divisor * divisor; ++i) {
    ivec2 quad = quadOf(i, divisor);
    BlockPixel pixel = blockPixel(four, pixelOf(first + 2 * quad, uint(i & 3)), push.divisor, size);
    vec4 w = pixel.parts;
    float total = dot(w, vec4(1.0));
    w = total > 1e-20 ? w / total : vec4(0.25);
    float mean = dot(w, bright);
    bool disagree = dot(w, abs(bright - mean)) > kDisagree * mean;
    bool crease = inCrease(pixel.at, pixel.plane, size - 1);
    if (pixel.inside && pixel.covered && (total < kGoodFit || disagree || crease))
      bad |= 1u << (i & 3) | (crease ? kQuadFlag : 0u);
    if ((i & 3) == 3 && bad != 0u) {
      uint free = atomicAdd(misfits.list.count_and_one, 1u) - 1u;
      if (free < push.capacity) misfits.at[free] = packQuad(ivec2(gl_GlobalInvocationID.xy) * (divisor / 2) + quad, bad);
      if (free > 0u && free < push.capacity && free % kPointRow == 0u) atomicAdd(misfits.list.groups_y, 1u);
      bad = 0u;
    }
    float shown = pixel.covered ? 1.0 : 0.0;
    if (pixel.inside) {
      imageStore(direct_full, pixel.at, vec4(lit * w * shown, 1.0));
      imageStore(indirect_full, pixel.at, vec4(sent * w * shown, 1.0));
    }
  }
}
