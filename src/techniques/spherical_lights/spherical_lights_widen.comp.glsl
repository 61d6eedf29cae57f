// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-8, the fix-up's first half: listed pixels are read from the sixteen receivers around, as far as these fit. Where they do not, or
// disagree, or in a crease, the middle of a square's pixels on one surface becomes a point that is lit from scratch (spherical_lights_repair).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "techniques/spherical_lights/spherical_lights_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform sampler2D receiver_normal;
layout(set = 0, binding = 4) uniform sampler2D direct;
layout(set = 0, binding = 5) uniform sampler2D indirect;
layout(scalar, set = 0, binding = 6) readonly buffer Misfits { QuadList list; uint at[]; } misfits;
layout(scalar, set = 0, binding = 7) buffer Repairs { QuadList list; uint at[]; } repairs;
layout(set = 0, binding = 8, rgba16f) uniform image2D direct_full;
layout(set = 0, binding = 9, rgba16f) uniform image2D indirect_full;
layout(set = 0, binding = 10) uniform writeonly image2D point_position;
layout(set = 0, binding = 11) uniform writeonly image2D point_normal;
layout(scalar, push_constant) uniform Push { uint divisor; uint capacity; uint repair_capacity; } push;

#include "frame/quads.glsl"
#include "techniques/spherical_lights/spherical_lights_disagree.glsl"

const float kEnough = 0.35;  // of weights of the sixteen, whose tents sum to 4

void main() {
  uint entry = gl_GlobalInvocationID.y * kPointColumns + gl_GlobalInvocationID.x;
  if (entry >= min(misfits.list.count_and_one - 1u, push.capacity)) return;
  uint packed = misfits.at[entry], left = packed & 15u;
  bool crease = (packed & kQuadFlag) != 0u;
  ivec2 first = firstPixel(packed, push.divisor), last = textureSize(receiver_normal, 0) - 1;
  while (left != 0u) {
    QuadSurface surface = surfaceOf(first, crease ? 1u << findLSB(left) : left, kSameNormal);  // there each pixel differs
    left &= ~surface.mask;
    vec2 leader_place = receiverPlace(surface.leader, push.divisor);
    vec2 place = leader_place + surface.middle / float(push.divisor);
    ivec2 corner = ivec2(floor(place)) - 1;
    float total = 0.0, bright = 0.0, squares = 0.0;
    vec2 offset = vec2(0.0);  // of the receivers' middle, in receivers
    vec3 lit = vec3(0.0), sent = vec3(0.0);
    for (int i = 0; i < 16; ++i) {
      ivec2 at = corner + ivec2(i & 3, i >> 2), from = clamp(at, ivec2(0), last);
      vec2 away = vec2(at) - place, tent = max(1.0 - 0.5 * abs(away), vec2(0.0));
      vec4 receiver = texelFetch(receiver_normal, from, 0);
      receiver.w = from == at ? evenDepth(frame_view.view, receiver.w) : 0.0;
      float fits = receiverFitness(receiver, surface.normal, surface.plane, (vec2(at) - leader_place) * float(push.divisor));
      float w = tent.x * tent.y * fits;
      vec3 from_direct = texelFetch(direct, from, 0).rgb, from_indirect = texelFetch(indirect, from, 0).rgb;
      float value = dot(kBrightness, from_direct + from_indirect);
      lit += w * from_direct;
      sent += w * from_indirect;
      bright += w * value;
      squares += w * value * value;
      total += w;
      offset += w * away;
    }
    float scale = 1.0 / max(total, 1e-20), mean = bright * scale;
    float deviation = sqrt(max(0.0, squares * scale - mean * mean));
    // What the average is off by where light has a slope and the receivers lie to one side.
    float off = deviation * length(offset) * scale;
    if (crease || total < kEnough || deviation > kDisagreeWide * mean || off > kOff * mean) {
      uint free = atomicAdd(repairs.list.count_and_one, 1u) - 1u;
      if (free < push.repair_capacity) {
        repairs.at[free] = packed & ~31u | surface.mask;
        ivec2 texel = ivec2(free % kPointColumns, free / kPointColumns);
        imageStore(point_position, texel, vec4(surface.position, 1.0));
        imageStore(point_normal, texel, vec4(surface.normal, 1.0));
      }
      if (free > 0u && free < push.repair_capacity && free % kPointRow == 0u) atomicAdd(repairs.list.groups_y, 1u);
    }
    if (total < 1e-6) continue;
    for (uint i = 0u; i < 4u; ++i) {
      if ((surface.mask >> i & 1u) == 0u) continue;
      imageStore(direct_full, pixelOf(first, i), vec4(lit * scale, 1.0));
      imageStore(indirect_full, pixelOf(first, i), vec4(sent * scale, 1.0));
    }
  }
}
