// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-10, in part: pixels that the four receivers around them fit badly (beside silhouettes) are read from the sixteen around, each
// as far as it fits, through the plane that fits their values best (moving least squares). So light goes on at its slope to the
// edge of a surface. Where sixteen do not tell the slope, the pixels go on to proxies_repair.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/upsample.glsl"
#include "frame/view.glsl"
#include "techniques/proxies/proxies_shared.h"

layout(constant_id = 0) const bool whole_field = false;
layout(constant_id = 1) const bool lends = false;  // proxies_round.glsl: worth it where pixels from scratch meet many proxies

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform sampler2D receiver_normal;
layout(set = 0, binding = 4) uniform sampler2DArray field;
layout(set = 0, binding = 5) uniform sampler2D indirect;  // A: what is left of the peak
layout(scalar, set = 0, binding = 6) uniform LightBlock { ProxyLight row; } light;
layout(scalar, set = 0, binding = 7) readonly buffer Misfits { QuadList list; uint at[]; } misfits;
layout(scalar, set = 0, binding = 10) buffer Repairs { QuadList list; uint at[]; } repairs;
layout(set = 0, binding = 8, rgba16f) uniform image2D direct_full;  // A: how much of it is kept
layout(set = 0, binding = 9, rgba16f) uniform image2D indirect_full;
layout(set = 0, binding = 11) uniform sampler2DArray visibility;  // O_p
layout(scalar, push_constant) uniform Push { uint divisor; uint capacity; uint repair_capacity; } push;

#include "frame/quads.glsl"
#include "techniques/proxies/proxies_round.glsl"
#include "techniques/proxies/proxies_shade.glsl"
#include "techniques/proxies/proxies_slope.glsl"

const float kFieldChanges = 3.0;  // light changes faster than the mean of visibility

void toRepairs(uint entry) {
  uint free = atomicAdd(repairs.list.count_and_one, 1u) - 1u;
  if (free < push.repair_capacity) repairs.at[free] = entry;
  if (free > 0u && free < push.repair_capacity && free % kRepairGroup == 0u) atomicAdd(repairs.list.groups_x, 1u);
}

/// Of what is not known of a pixel yet, that share.
void blendIn(ivec2 pixel, vec3 lit, vec3 sent, float known) {
  vec4 before = imageLoad(direct_full, pixel);
  float kept = before.a + (1.0 - before.a) * known, share = before.a / kept;
  vec3 sent_before = imageLoad(indirect_full, pixel).rgb;
  imageStore(direct_full, pixel, vec4(mix(lit, before.rgb, share), kept));
  imageStore(indirect_full, pixel, vec4(mix(sent, sent_before, share), 1.0));
}

void main() {
  uint entry = gl_GlobalInvocationID.x;
  if (entry >= min(misfits.list.count_and_one - 1u, push.capacity)) return;
  uint packed = misfits.at[entry], left = packed & 15u;
  ivec2 first = firstPixel(packed, push.divisor), last = textureSize(receiver_normal, 0) - 1;
  uint unknown = 0u;
  while (left != 0u) {
    QuadSurface surface = surfaceOf(first, left, kSameSurface);
    left &= ~surface.mask;
    vec2 leader_place = receiverPlace(surface.leader, push.divisor);
    vec2 place = leader_place + surface.middle / float(push.divisor);
    ivec2 corner = ivec2(floor(place)) - 1;
    float weights[16];
    float s = 0.0;
    vec3 xx = vec3(0.0);
    vec2 x1 = vec2(0.0);
    for (int i = 0; i < 16; ++i) {
      ivec2 at = corner + ivec2(i & 3, i >> 2);
      vec2 x = vec2(at) - place, tent = max(1.0 - 0.5 * abs(x), vec2(0.0));
      vec4 receiver = texelFetch(receiver_normal, clamp(at, ivec2(0), last), 0);
      receiver.w = clamp(at, ivec2(0), last) == at ? evenDepth(frame_view.view, receiver.w) : 0.0;
      float w = tent.x * tent.y * receiverFitness(receiver, surface.normal, surface.plane,
                                                  (vec2(at) - leader_place) * float(push.divisor));
      weights[i] = w;
      s += w, x1 += w * x, xx += w * vec3(x.x * x.x, x.x * x.y, x.y * x.y);
    }
    Slope slope = slopeOf(s, x1, xx);
    vec4 f0 = vec4(0.0), f1 = vec4(0.0), f2 = vec4(0.0), f3 = vec4(0.0), sent = vec4(0.0);
    float enlarged = 0.0, v2 = 0.0;
    vec3 v = vec3(0.0);  // values' sums, for what the plane leaves over
    vec2 offset = vec2(0.0);
    vec4 n = vec4(surface.normal, 1.0);
    float peak = dot(light.row.peak.irradiance, vec3(max(0.0, dot(surface.normal, light.row.peak.direction))));
    for (int i = 0; i < 16; ++i) {
      ivec2 at = corner + ivec2(i & 3, i >> 2), from = clamp(at, ivec2(0), last);
      vec2 x = vec2(at) - place;
      float a = weights[i] * (slope.c.x + dot(slope.c.yz, x));
      enlarged += abs(a), offset += a * x;
      vec4 g0 = texelFetch(field, ivec3(from, 0), 0), g1 = texelFetch(field, ivec3(from, 1), 0);
      vec4 g2 = texelFetch(field, ivec3(from, 2), 0), g4 = texelFetch(indirect, from, 0);
      f0 += a * g0, f1 += a * g1, f2 += a * g2, sent += a * g4;
      float value = whole_field ? g0.x : dot(g0 + g1 + g2, n) + peak * g4.a;
      v += weights[i] * value * vec3(1.0, x);
      v2 += weights[i] * value * value;
      if (whole_field) f3 += a * texelFetch(field, ivec3(from, 3), 0);
    }
    float value = whole_field ? f0.x : dot(f0 + f1 + f2, n) + peak * sent.a;
    float bent = sqrt(max(0.0, v2 - dot(v, slope.solve * v)) / max(s, 1e-12)) / max(abs(value), 1e-12);
    float known = trusted(s, offset, enlarged, whole_field ? kFieldChanges * bent : bent);
    unknown |= known < 0.99 ? surface.mask : 0u;
    if (known <= 0.01) continue;
    for (uint i = 0u; i < 4u; ++i) {
      if ((surface.mask >> i & 1u) == 0u) continue;
      ivec2 pixel = pixelOf(first, i);
      vec3 normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
      vec3 lit = whole_field ? litThrough(float[16](f0.x, f0.y, f0.z, f0.w, f1.x, f1.y, f1.z, f1.w, f2.x, f2.y, f2.z,
                                                    f2.w, f3.x, f3.y, f3.z, f3.w), normal)
                             : litByPlanes(f0, f1, f2, sent.a, normal);
      blendIn(pixel, lit, max(sent.rgb, vec3(0.0)), known);
    }
  }
  while (unknown != 0u) {
    uint mask = oneReceiver(first, unknown);
    unknown &= ~mask;
    if (!lends) {
      toRepairs(packed & ~31u | mask);
      continue;
    }
    Lent lent = lentTo(first, mask);
    for (uint i = 0u; lent.known > 0.0 && i < 4u; ++i) {
      if ((mask >> i & 1u) == 0u) continue;
      ivec2 pixel = pixelOf(first, i);
      blendIn(pixel, litAt(lent, shadingNormal(texelFetch(normals, pixel, 0).xy)), lent.sent, lent.known);
    }
    if (lent.known < 0.99) toRepairs(packed & ~31u | mask);
  }
}
