// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-8: the block of pixels between the same four receivers, and these receivers' parts in each of its pixels (upsample.glsl).
// Includers declare frame_view, depth, normals, and receiver_normal: shading normals of receivers; w: depth along the axis, 0: background.
#ifndef GLOAM_FRAME_FOUR_RECEIVERS_GLSL
#define GLOAM_FRAME_FOUR_RECEIVERS_GLSL
#include "frame/quads.glsl"

struct FourReceivers {
  ivec2 at;  // of the first; -1: before the first of all
  ivec2 p00, p10, p01, p11;
  vec4 r00, r10, r01, r11;  // normals and even depths
};
vec4 receiverAt(ivec2 place) {
  vec4 receiver = texelFetch(receiver_normal, place, 0);
  return vec4(receiver.xyz, evenDepth(frame_view.view, receiver.w));
}
FourReceivers fourReceivers(ivec2 block) {
  FourReceivers four;
  ivec2 last = textureSize(receiver_normal, 0) - 1;
  four.at = block - 1;
  four.p00 = clamp(four.at, ivec2(0), last);
  four.p11 = min(four.p00 + 1, last);
  four.p10 = ivec2(four.p11.x, four.p00.y);
  four.p01 = ivec2(four.p00.x, four.p11.y);
  four.r00 = receiverAt(four.p00), four.r10 = receiverAt(four.p10);
  four.r01 = receiverAt(four.p01), four.r11 = receiverAt(four.p11);
  return four;
}

/// The square that the block's i-th pixel belongs to, four of them each. divisor: a power of two, as software drivers divide lane by lane.
ivec2 quadOf(int i, int divisor) {
  int half_divisor = divisor / 2;
  return ivec2((i >> 2) & (half_divisor - 1), i >> (2 + findMSB(half_divisor)));
}

struct BlockPixel {
  ivec2 at;
  bool inside, covered;  // the picture has it; it shows a surface
  vec3 normal;           // shading
  PixelPlane plane;
  vec4 parts;  // of the receivers 00, 10, 01, 11
};
/// A receiver's part in a pixel that lies `away` pixels from it.
float partOf(vec4 receiver, vec2 bilinear, vec3 normal, PixelPlane plane, vec2 away) {
  return max(bilinear.x * bilinear.y, kLeastBilinear) * receiverFitness(receiver, normal, plane, away);
}
BlockPixel blockPixel(FourReceivers four, ivec2 pixel, uint divisor, ivec2 size) {
  BlockPixel p;
  p.inside = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
  p.at = clamp(pixel, ivec2(0), size - 1);
  float d = texelFetch(depth, p.at, 0).x;
  p.covered = d > 0.0;
  float along = eyeDepth(frame_view.view, p.covered ? d : 1.0);
  uvec2 packed = texelFetch(normals, p.at, 0).xy;
  p.normal = shadingNormal(packed);
  p.plane = pixelPlane(frame_view.view, p.at, along, geometricNormal(packed));
  vec2 place = receiverPlace(p.at, divisor), f = place - vec2(four.at);
  vec2 near = (vec2(four.p00) - place) * float(divisor), far = (vec2(four.p11) - place) * float(divisor);
  f = mix(f, vec2(0.0), lessThan(four.at, ivec2(0)));
  p.parts = vec4(partOf(four.r00, 1.0 - f, p.normal, p.plane, near),
                 partOf(four.r10, vec2(f.x, 1.0 - f.y), p.normal, p.plane, vec2(far.x, near.y)),
                 partOf(four.r01, vec2(1.0 - f.x, f.y), p.normal, p.plane, vec2(near.x, far.y)),
                 partOf(four.r11, f, p.normal, p.plane, far));
  return p;
}

#endif
