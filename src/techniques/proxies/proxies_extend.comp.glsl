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

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform sampler2D receiver_normal;
layout(set = 0, binding = 4) uniform sampler2DArray field;
layout(set = 0, binding = 5) uniform sampler2D indirect;
layout(scalar, set = 0, binding = 6) uniform LightBlock { ProxyLight row; } light;
layout(scalar, set = 0, binding = 7) readonly buffer Misfits { RepairList list; uint at[]; } misfits;
layout(scalar, set = 0, binding = 10) buffer Repairs { RepairList list; uint at[]; } repairs;
layout(set = 0, binding = 8, rgba16f) uniform image2D direct_full;  // A: how much of it is kept
layout(set = 0, binding = 9, rgba16f) uniform image2D indirect_full;
layout(scalar, push_constant) uniform Push { uint divisor; uint capacity; uint repair_capacity; } push;

#include "techniques/proxies/proxies_quads.glsl"
#include "techniques/proxies/proxies_shade.glsl"

const float kSameSurface = 0.8;  // fitness of pixels that share their light
/// Of squared receivers: what keeps the slope at 0 across receivers that stand in a line.
const float kStiffness = 0.03;
/// What is trusted, and what no longer: the offset of the receivers' weighted middle (in receivers); the sum of weights without
/// their signs, by which errors are enlarged; distance of values from their plane, relative to the value read; and, from the second
/// to the first, weights of what fits.
const vec2 kOffset = vec2(0.05, 0.2), kEnlarged = vec2(1.5, 2.2), kBent = vec2(0.006, 0.018), kWeight = vec2(0.8, 0.4);

const float kFieldChanges = 3.0;  // light changes faster than the mean of visibility

void main() {
  uint entry = gl_GlobalInvocationID.x;
  if (entry >= min(misfits.list.count_and_one - 1u, push.capacity)) return;
  uint packed = misfits.at[entry], left = packed & 15u;
  ivec2 first = firstPixel(packed, push.divisor), last = textureSize(receiver_normal, 0) - 1;
  while (left != 0u) {
    ivec2 leader = pixelOf(first, uint(findLSB(left)));
    float along = eyeDepth(frame_view.view, texelFetch(depth, leader, 0).x);
    uvec2 leader_normals = texelFetch(normals, leader, 0).xy;
    vec3 leading = shadingNormal(leader_normals), normal = vec3(0.0);
    PixelPlane plane = pixelPlane(frame_view.view, leader, along, geometricNormal(leader_normals));
    uint group = 0u;
    vec2 middle = vec2(0.0);  // from the leader
    for (uint i = 0u; i < 4u; ++i) {
      ivec2 pixel = pixelOf(first, i);
      if ((left >> i & 1u) == 0u) continue;
      vec3 n = shadingNormal(texelFetch(normals, pixel, 0).xy);
      float d = evenDepth(frame_view.view, eyeDepth(frame_view.view, texelFetch(depth, pixel, 0).x));
      if (pixel != leader && receiverFitness(vec4(n, d), leading, plane, vec2(pixel - leader)) < kSameSurface)
        continue;
      group |= 1u << i;
      normal += n;
      middle += vec2(pixel - leader);
    }
    left &= ~group;
    normal = normalize(normal);
    middle /= float(bitCount(group));
    vec2 leader_place = receiverPlace(leader, push.divisor), place = leader_place + middle / float(push.divisor);
    ivec2 corner = ivec2(floor(place)) - 1;
    float weights[16];
    float s = 0.0;
    vec3 xx = vec3(0.0);  // xx, xy, yy
    vec2 x1 = vec2(0.0);
    for (int i = 0; i < 16; ++i) {
      ivec2 at = corner + ivec2(i & 3, i >> 2);
      vec2 x = vec2(at) - place, tent = max(1.0 - 0.5 * abs(x), vec2(0.0));
      vec4 receiver = texelFetch(receiver_normal, clamp(at, ivec2(0), last), 0);
      receiver.w = clamp(at, ivec2(0), last) == at ? evenDepth(frame_view.view, receiver.w) : 0.0;
      float w = tent.x * tent.y *
                receiverFitness(receiver, normal, plane, (vec2(at) - leader_place) * float(push.divisor));
      weights[i] = w;
      s += w, x1 += w * x, xx += w * vec3(x.x * x.x, x.x * x.y, x.y * x.y);
    }
    // Values' sums, for what the plane leaves over.
    float v2 = 0.0;
    vec3 v = vec3(0.0);
    // The c of a_i = w_i (c.x + c.y x_i + c.z y_i) with sums of a_i, a_i x_i, a_i y_i of 1, 0, 0, but for the stiffness.
    float stiff = kStiffness * s + 1e-12, p = xx.x + stiff, q = xx.z + stiff, r = xx.y;
    vec3 c = vec3(p * q - r * r, r * x1.y - q * x1.x, r * x1.x - p * x1.y);
    float determinant = s * c.x + x1.x * c.y + x1.y * c.z;
    float inverse = 1.0 / max(determinant, 1e-20);
    mat3 solve = inverse * mat3(c, vec3(c.y, s * q - x1.y * x1.y, x1.x * x1.y - s * r),
                                vec3(c.z, x1.x * x1.y - s * r, s * p - x1.x * x1.x));
    c *= inverse;
    vec4 f0 = vec4(0.0), f1 = vec4(0.0), f2 = vec4(0.0), f3 = vec4(0.0);
    vec3 sent = vec3(0.0);
    float enlarged = 0.0;
    vec2 offset = vec2(0.0);
    for (int i = 0; i < 16; ++i) {
      ivec2 at = corner + ivec2(i & 3, i >> 2), from = clamp(at, ivec2(0), last);
      vec2 x = vec2(at) - place;
      float a = weights[i] * (c.x + dot(c.yz, x));
      enlarged += abs(a), offset += a * x;
      vec4 g0 = texelFetch(field, ivec3(from, 0), 0), g1 = texelFetch(field, ivec3(from, 1), 0);
      vec4 g2 = texelFetch(field, ivec3(from, 2), 0);
      f0 += a * g0, f1 += a * g1, f2 += a * g2;
      float value = whole_field ? g0.x : dot(g0 + g1 + g2, vec4(normal, 1.0));
      v += weights[i] * value * vec3(1.0, x);
      v2 += weights[i] * value * value;
      if (whole_field) f3 += a * texelFetch(field, ivec3(from, 3), 0);
      sent += a * texelFetch(indirect, from, 0).rgb;
    }
    float value = whole_field ? f0.x : dot(f0 + f1 + f2, vec4(normal, 1.0));
    float bent = sqrt(max(0.0, v2 - dot(v, solve * v)) / max(s, 1e-12)) / max(abs(value), 1e-12);
    if (whole_field) bent *= kFieldChanges;
    float known = smoothstep(kWeight.y, kWeight.x, s) * (1.0 - smoothstep(kOffset.x, kOffset.y, length(offset))) *
                  (1.0 - smoothstep(kEnlarged.x, kEnlarged.y, enlarged)) *
                  (1.0 - smoothstep(kBent.x, kBent.y, bent));
    if (known < 0.99) {
      uint free = atomicAdd(repairs.list.count_and_one, 1u) - 1u;
      if (free < push.repair_capacity) repairs.at[free] = packed & ~15u | group;
      if (free > 0u && free < push.repair_capacity && free % kRepairGroup == 0u)
        atomicAdd(repairs.list.groups_x, 1u);
    }
    if (known <= 0.01) continue;
    for (uint i = 0u; i < 4u; ++i) {
      if ((group >> i & 1u) == 0u) continue;
      ivec2 pixel = pixelOf(first, i);
      vec4 n = vec4(shadingNormal(texelFetch(normals, pixel, 0).xy), 1.0);
      vec3 lit;
      if (whole_field) {
        lit = litThrough(float[16](f0.x, f0.y, f0.z, f0.w, f1.x, f1.y, f1.z, f1.w, f2.x, f2.y, f2.z, f2.w,
                                          f3.x, f3.y, f3.z, f3.w), n.xyz);
      } else {
        lit = max(vec3(dot(f0, n), dot(f1, n), dot(f2, n)), vec3(0.0));
      }
      vec4 before = imageLoad(direct_full, pixel);
      float kept = before.a + (1.0 - before.a) * known, share = before.a / kept;
      vec3 sent_before = imageLoad(indirect_full, pixel).rgb;
      imageStore(direct_full, pixel, vec4(mix(lit, before.rgb, share), kept));
      imageStore(indirect_full, pixel, vec4(mix(max(sent, vec3(0.0)), sent_before, share), 1.0));
    }
  }
}
