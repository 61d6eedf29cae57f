// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pixels of things so small and round that hardly a receiver faces as they do: what is visible depends on normals far less than light
// does, so it is taken from the four receivers around that stand on the same thing, and shaded at each pixel's normal. Includers declare
// frame_view, depth, normals, receiver_normal, visibility, indirect, light and push.divisor.
#ifndef GLOAM_PROXIES_ROUND_GLSL
#define GLOAM_PROXIES_ROUND_GLSL
#include "frame/quads.glsl"
#include "techniques/proxies/proxies_shade.glsl"

/// What counts as round, in 1 - cosine of normals from one pixel to the next (4.3 and 6.7 degrees), and which receivers then serve, in the
/// cosine of normals. What is trusted: weights of those that do.
const vec2 kTurns = vec2(0.0028, 0.0068), kFaces = vec2(0.4, 0.8), kServes = vec2(0.15, 0.4);

/// 0 to 1: how round a surface is at a pixel, by what of its neighbours lies on it.
float roundness(ivec2 pixel, vec3 normal, PixelPlane plane) {
  float turned = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = (i < 2 ? ivec2(1, 0) : ivec2(0, 1)) * (1 - 2 * (i & 1));
    ivec2 at = clamp(pixel + step, ivec2(0), textureSize(depth, 0) - 1);
    float d = texelFetch(depth, at, 0).x, even = d > 0.0 ? evenDepth(frame_view.view, eyeDepth(frame_view.view, d)) : 0.0;
    float turn = 1.0 - dot(normal, shadingNormal(texelFetch(normals, at, 0).xy));
    bool same = receiverFitness(vec4(normal, even), normal, plane, vec2(step)) > kSamePlace && turn < 1.0 - kSameReceiver;
    turned = same ? max(turned, turn) : turned;
  }
  return smoothstep(kTurns.x, kTurns.y, turned);
}

/// What receivers know of pixels that oneReceiver put together.
struct Lent {
  float known;    // 0 to 1: how far it is to be trusted
  vec3 terms[9];  // of irradiance (field_shade.glsl)
  vec3 peak, sent;
};
Lent lentTo(ivec2 first, uint mask) {
  Lent lent;
  ivec2 leader = pixelOf(first, uint(findLSB(mask))), last = textureSize(receiver_normal, 0) - 1;
  uvec2 packed = texelFetch(normals, leader, 0).xy;
  vec3 normal = shadingNormal(packed);
  PixelPlane plane = pixelPlane(frame_view.view, leader, eyeDepth(frame_view.view, texelFetch(depth, leader, 0).x),
                                geometricNormal(packed));
  lent.known = roundness(leader, normal, plane);
  if (lent.known == 0.0) return lent;
  vec2 place = receiverPlace(leader, push.divisor), part = fract(place);
  float s = 0.0;
  vec4 f0 = vec4(0.0), f1 = vec4(0.0), f2 = vec4(0.0), f3 = vec4(0.0), sent = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1), at = ivec2(floor(place)) + corner, from = clamp(at, ivec2(0), last);
    vec4 receiver = texelFetch(receiver_normal, from, 0);
    vec2 bilinear = mix(1.0 - part, part, vec2(corner));
    float even = from == at ? evenDepth(frame_view.view, receiver.w) : 0.0;
    float w = bilinear.x * bilinear.y * smoothstep(kFaces.x, kFaces.y, dot(receiver.xyz, normal)) *
              receiverFitness(vec4(normal, even), normal, plane, (vec2(at) - place) * float(push.divisor));
    if (w <= 0.0) continue;
    s += w;
    f0 += w * texelFetch(visibility, ivec3(from, 0), 0), f1 += w * texelFetch(visibility, ivec3(from, 1), 0);
    f2 += w * texelFetch(visibility, ivec3(from, 2), 0), f3 += w * texelFetch(visibility, ivec3(from, 3), 0);
    sent += w * texelFetch(indirect, from, 0);
  }
  lent.known *= smoothstep(kServes.x, kServes.y, s);
  if (lent.known == 0.0) return lent;
  f0 /= s, f1 /= s, f2 /= s, f3 /= s;
  float o[16] = float[16](f0.x, f0.y, f0.z, f0.w, f1.x, f1.y, f1.z, f1.w, f2.x, f2.y, f2.z, f2.w, f3.x, f3.y, f3.z, f3.w);
  shadeTerms(o, lent.terms);
  lent.peak = peakLeft(light.row.peak, o) * light.row.peak.irradiance;
  lent.sent = max(sent.rgb / s, vec3(0.0));
  return lent;
}
vec3 litAt(Lent lent, vec3 normal) {
  return max(irradianceOf(lent.terms, normal), vec3(0.0)) + lent.peak * max(0.0, dot(normal, light.row.peak.direction));
}

#endif
