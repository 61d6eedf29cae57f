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
layout(scalar, set = 0, binding = 6) buffer Misfits { PixelList list; uint at[]; } misfits;
layout(set = 0, binding = 7) uniform writeonly image2D direct_full;
layout(set = 0, binding = 8) uniform writeonly image2D indirect_full;
layout(scalar, push_constant) uniform Push { uint divisor; uint capacity; } push;

#include "frame/quads.glsl"
#include "techniques/spherical_lights/spherical_lights_disagree.glsl"

vec4 receiverAt(ivec2 place) {
  vec4 receiver = texelFetch(receiver_normal, place, 0);
  return vec4(receiver.xyz, evenDepth(frame_view.view, receiver.w));
}
/// A receiver's part in a pixel that lies `away` pixels from it.
float weightOf(vec4 receiver, vec2 bilinear, vec3 normal, PixelPlane plane, vec2 away) {
  return max(bilinear.x * bilinear.y, kLeastBilinear) * receiverFitness(receiver, normal, plane, away);
}

void main() {
  int divisor = int(push.divisor);
  ivec2 size = imageSize(direct_full), first = ivec2(gl_GlobalInvocationID.xy) * divisor - divisor / 2;
  if (any(greaterThanEqual(first, size))) return;
  ivec2 last = textureSize(receiver_normal, 0) - 1;
  ivec2 at = ivec2(gl_GlobalInvocationID.xy) - 1;  // -1: before the first receiver
  ivec2 p00 = clamp(at, ivec2(0), last), p11 = min(p00 + 1, last);
  ivec2 p10 = ivec2(p11.x, p00.y), p01 = ivec2(p00.x, p11.y);
  vec4 r00 = receiverAt(p00), r10 = receiverAt(p10), r01 = receiverAt(p01), r11 = receiverAt(p11);
#define GLOAM_FOUR(image)                                                                                        \
  mat4x3(texelFetch(image, p00, 0).rgb, texelFetch(image, p10, 0).rgb, texelFetch(image, p01, 0).rgb,            \
         texelFetch(image, p11, 0).rgb)
  mat4x3 lit = GLOAM_FOUR(direct), sent = GLOAM_FOUR(indirect);
  vec4 bright = brightnessOf(lit) + brightnessOf(sent);
  int half_divisor = divisor / 2, shift = findMSB(half_divisor);  // a power of two: software drivers divide lane by lane
  uint bad = 0u;  // of a square of 2 x 2 pixels; with kQuadFlag if in a crease
  for (int i = 0; i < divisor * divisor; ++i) {
    ivec2 quad = ivec2((i >> 2) & (half_divisor - 1), i >> (2 + shift));
    ivec2 pixel = pixelOf(first + 2 * quad, uint(i & 3));
    bool inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
    pixel = clamp(pixel, ivec2(0), size - 1);
    float d = texelFetch(depth, pixel, 0).x;
    bool covered = d > 0.0;
    float along = eyeDepth(frame_view.view, covered ? d : 1.0);
    uvec2 packed = texelFetch(normals, pixel, 0).xy;
    vec3 normal = shadingNormal(packed);
    PixelPlane plane = pixelPlane(frame_view.view, pixel, along, geometricNormal(packed));
    vec2 place = receiverPlace(pixel, push.divisor), f = place - vec2(at);
    vec2 near = (vec2(p00) - place) * float(divisor), far = (vec2(p11) - place) * float(divisor);
    f = mix(f, vec2(0.0), lessThan(at, ivec2(0)));
    vec4 w = vec4(weightOf(r00, 1.0 - f, normal, plane, near),
                  weightOf(r10, vec2(f.x, 1.0 - f.y), normal, plane, vec2(far.x, near.y)),
                  weightOf(r01, vec2(1.0 - f.x, f.y), normal, plane, vec2(near.x, far.y)),
                  weightOf(r11, f, normal, plane, far));
    float total = dot(w, vec4(1.0));
    w = total > 1e-20 ? w / total : vec4(0.25);
    float mean = dot(w, bright);
    bool disagree = dot(w, abs(bright - mean)) > kDisagree * mean;
    bool crease = inCrease(pixel, plane, size - 1);
    if (inside && covered && (total < kGoodFit || disagree || crease))
      bad |= 1u << (i & 3) | (crease ? kQuadFlag : 0u);
    if ((i & 3) == 3 && bad != 0u) {
      uint free = atomicAdd(misfits.list.count_and_one, 1u) - 1u;
      if (free < push.capacity) misfits.at[free] = packQuad(ivec2(gl_GlobalInvocationID.xy) * half_divisor + quad, bad);
      if (free > 0u && free < push.capacity && free % kPointRow == 0u) atomicAdd(misfits.list.groups_y, 1u);
      bad = 0u;
    }
    float shown = covered ? 1.0 : 0.0;
    if (inside) {
      imageStore(direct_full, pixel, vec4(lit * w * shown, 1.0));
      imageStore(indirect_full, pixel, vec4(sent * w * shown, 1.0));
    }
  }
}
