// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pixels that stand on lists, by squares of 2 x 2: a word has the square's place, a bit for each of its pixels, and one of the list's own.
// Includers declare frame_view, depth, normals.
#ifndef GLOAM_FRAME_QUADS_GLSL
#define GLOAM_FRAME_QUADS_GLSL
#include "frame/gbuffer.glsl"
#include "frame/upsample.glsl"
#include "frame/view.glsl"

/// Fitness of pixels of a square that lie on one surface; of those that, besides, get light of one normal: within 3 degrees.
const float kSameSurface = 0.8, kSameNormal = 0.95;

/// quad: in squares, counted from the first that `divisor` has (upsampling begins half a block before the picture).
uint packQuad(ivec2 quad, uint mask) { return uint(quad.y) << 18 | uint(quad.x) << 5 | mask; }
const uint kQuadFlag = 16u;
ivec2 firstPixel(uint packed, uint divisor) {
  return 2 * ivec2(packed >> 5 & 0x1fffu, packed >> 18) - int(divisor / 2u);
}
ivec2 pixelOf(ivec2 first, uint which) { return first + ivec2(which & 1u, which >> 1); }

/// Those of a square's pixels in `left` that lie on the surface of the first of them, with at least the fitness `same`.
struct QuadSurface {
  uint mask;
  ivec2 leader;
  vec2 middle;            // of them, in pixels from the leader
  vec3 position, normal;  // means
  PixelPlane plane;       // the leader's
};
QuadSurface surfaceOf(ivec2 first, uint left, float same) {
  QuadSurface s;
  s.leader = pixelOf(first, uint(findLSB(left)));
  float along = eyeDepth(frame_view.view, texelFetch(depth, s.leader, 0).x);
  uvec2 packed = texelFetch(normals, s.leader, 0).xy;
  vec3 leading = shadingNormal(packed);
  s.plane = pixelPlane(frame_view.view, s.leader, along, geometricNormal(packed));
  s.mask = 0u;
  s.middle = vec2(0.0);
  s.position = s.normal = vec3(0.0);
  for (uint i = 0u; i < 4u; ++i) {
    ivec2 pixel = pixelOf(first, i);
    if ((left >> i & 1u) == 0u) continue;
    vec3 n = shadingNormal(texelFetch(normals, pixel, 0).xy);
    float away = eyeDepth(frame_view.view, texelFetch(depth, pixel, 0).x);
    vec4 as_receiver = vec4(n, evenDepth(frame_view.view, away));
    if (pixel != s.leader && receiverFitness(as_receiver, leading, s.plane, vec2(pixel - s.leader)) < same)
      continue;
    Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
    s.position += ray.origin + ray.direction * away;
    s.normal += n;
    s.middle += vec2(pixel - s.leader);
    s.mask |= 1u << i;
  }
  float count = float(bitCount(s.mask));
  s.position /= count;
  s.middle /= count;
  s.normal = normalize(s.normal);
  return s;
}

/// Those of a square's pixels in `left`, the first of them among them, that one receiver at their mean place and normal stands for.
/// What is visible depends on normals far less than light does, which is shaded at each: so small round things, on which no two
/// pixels have one surface, are computed once a square.
const float kSameReceiver = 0.8, kSamePlace = 0.25;  // of normals' cosine; of depth, as receiverFitness has it
uint oneReceiver(ivec2 first, uint left) {
  uint which = uint(findLSB(left)), mask = 1u << which;
  ivec2 leader = pixelOf(first, which);
  uvec2 packed = texelFetch(normals, leader, 0).xy;
  vec3 leading = shadingNormal(packed);
  PixelPlane plane = pixelPlane(frame_view.view, leader, eyeDepth(frame_view.view, texelFetch(depth, leader, 0).x),
                                geometricNormal(packed));
  for (uint i = which + 1u; i < 4u; ++i) {
    ivec2 pixel = pixelOf(first, i);
    if ((left >> i & 1u) == 0u) continue;
    float along = evenDepth(frame_view.view, eyeDepth(frame_view.view, texelFetch(depth, pixel, 0).x));
    bool turned = dot(leading, shadingNormal(texelFetch(normals, pixel, 0).xy)) < kSameReceiver;
    float place = receiverFitness(vec4(leading, along), leading, plane, vec2(pixel - leader));
    mask |= !turned && place > kSamePlace ? 1u << i : 0u;
  }
  return mask;
}

/// A surface rises from the pixel's own within a pixel of it, as where a wall stands on its ground: light changes there faster than
/// receivers can tell. In pixels: from a slope of 0.3 on, up to where it is something in front.
bool inCrease(ivec2 pixel, PixelPlane plane, ivec2 last) {
  bool parallel = frame_view.view.depth_range > 0.0;
  float unit = length(frame_view.view.step_x) * (parallel ? -1.0 : plane.depth);
  bool found = false;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = (i < 2 ? ivec2(1, 0) : ivec2(0, 1)) * (1 - 2 * (i & 1));
    float d = texelFetch(depth, clamp(pixel + step, ivec2(0), last), 0).x;
    float rise = (evenDepth(frame_view.view, eyeDepth(frame_view.view, d)) - plane.depth - dot(plane.change, vec2(step))) / unit;
    found = found || (d > 0.0 && rise > 0.3 && rise < 8.0);
  }
  return found;
}

#endif
