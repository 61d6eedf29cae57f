// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-8: O_p, or irradiance with its change by the normal, and indirect irradiance brought to every pixel along surfaces; direct
// light is shaded there, at the pixel's own normal. Pixels that the four receivers around them fit badly go on a list (proxies_extend).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/upsample.glsl"
#include "frame/view.glsl"
#include "techniques/proxies/proxies_shared.h"

layout(constant_id = 0) const bool whole_field = false;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform sampler2D receiver_normal;  // w: depth along the axis, 0: background
layout(set = 0, binding = 4) uniform sampler2DArray field;  // O_p, or planes: red, green, blue
layout(set = 0, binding = 5) uniform sampler2D indirect;  // A: what is left of the peak
layout(scalar, set = 0, binding = 6) uniform LightBlock { ProxyLight row; } light;
layout(scalar, set = 0, binding = 7) buffer Misfits { RepairList list; uint at[]; } misfits;
layout(set = 0, binding = 8) uniform writeonly image2D direct_full;
layout(set = 0, binding = 9) uniform writeonly image2D indirect_full;
layout(scalar, push_constant) uniform Push { uint divisor; uint capacity; } push;

#include "frame/quads.glsl"
#include "techniques/proxies/proxies_shade.glsl"

vec4 receiverAt(ivec2 place) {
  vec4 receiver = texelFetch(receiver_normal, place, 0);
  return vec4(receiver.xyz, evenDepth(frame_view.view, receiver.w));
}
/// A receiver's part in a pixel that lies `away` pixels from it.
float weightOf(vec4 receiver, vec2 bilinear, vec3 normal, PixelPlane plane, vec2 away) {
  return max(bilinear.x * bilinear.y, kLeastBilinear) * receiverFitness(receiver, normal, plane, away);
}

// Pixels between the same four receivers go through one invocation, which reads these once.
void main() {
  int divisor = int(push.divisor);
  ivec2 size = imageSize(direct_full), first = ivec2(gl_GlobalInvocationID.xy) * divisor - divisor / 2;
  if (any(greaterThanEqual(first, size))) return;
  ivec2 last = textureSize(receiver_normal, 0) - 1;
  ivec2 at = ivec2(gl_GlobalInvocationID.xy) - 1;  // -1: before the first receiver
  ivec2 p00 = clamp(at, ivec2(0), last), p11 = min(p00 + 1, last);
  ivec2 p10 = ivec2(p11.x, p00.y), p01 = ivec2(p00.x, p11.y);
  vec4 r00 = receiverAt(p00), r10 = receiverAt(p10), r01 = receiverAt(p01), r11 = receiverAt(p11);
  vec4 s00 = texelFetch(indirect, p00, 0), s10 = texelFetch(indirect, p10, 0);
  vec4 s01 = texelFetch(indirect, p01, 0), s11 = texelFetch(indirect, p11, 0);
#define GLOAM_FIELD(layer)                                                                                  \
  mat4(texelFetch(field, ivec3(p00, layer), 0), texelFetch(field, ivec3(p10, layer), 0),                    \
       texelFetch(field, ivec3(p01, layer), 0), texelFetch(field, ivec3(p11, layer), 0))
  mat4 f0 = GLOAM_FIELD(0), f1 = GLOAM_FIELD(1), f2 = GLOAM_FIELD(2), f3 = whole_field ? GLOAM_FIELD(3) : mat4(0.0);
  int half_divisor = divisor / 2, shift = findMSB(half_divisor);  // a power of two: software drivers divide lane by lane
  uint bad = 0u;  // of a square of 2 x 2 pixels
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
    float total = w.x + w.y + w.z + w.w;
    float kept = 1.0;  // of what receivers say
    if (inside && covered && total < kGoodFit) {
      bad |= 1u << (i & 3);
      kept = smoothstep(kScratchFit, kGoodFit, total);
    }
    if ((i & 3) == 3 && bad != 0u) {
      uint free = atomicAdd(misfits.list.count_and_one, 1u) - 1u;
      if (free < push.capacity) misfits.at[free] = packQuad(ivec2(gl_GlobalInvocationID.xy) * half_divisor + quad, bad);
      if (free > 0u && free < push.capacity && free % kRepairGroup == 0u) atomicAdd(misfits.list.groups_x, 1u);
      bad = 0u;
    }
    w = total > 1e-20 ? w / total : vec4(0.25);
    vec4 a = f0 * w, b = f1 * w, c = f2 * w;
    vec4 sent = w.x * s00 + w.y * s10 + w.z * s01 + w.w * s11;
    vec3 lit;
    if (whole_field) {
      vec4 e = f3 * w;
      lit = litThrough(
          float[16](a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z, c.w, e.x, e.y, e.z, e.w), normal);
    } else {
      lit = litByPlanes(a, b, c, sent.a, normal);
    }
    float shown = covered ? 1.0 : 0.0;
    if (inside) {
      imageStore(direct_full, pixel, vec4(lit * shown, kept));
      imageStore(indirect_full, pixel, vec4(sent.rgb * shown, 1.0));
    }
  }
}
