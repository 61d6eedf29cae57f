// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-8: O_p, or irradiance with its change by the normal, and indirect irradiance brought to every pixel along surfaces; direct
// light is shaded there, at the pixel's own normal. Pixels that none of the four receivers around them fits go on a list (proxies_repair).
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
layout(set = 0, binding = 5) uniform sampler2D indirect;
layout(scalar, set = 0, binding = 6) uniform LightBlock { ProxyLight row; } light;
layout(scalar, set = 0, binding = 7) buffer Repairs { RepairList list; uint at[]; } repairs;
layout(set = 0, binding = 8) uniform writeonly image2D direct_full;
layout(set = 0, binding = 9) uniform writeonly image2D indirect_full;
layout(scalar, push_constant) uniform Push { uint divisor; uint capacity; } push;

#include "techniques/proxies/proxies_shade.glsl"

ivec2 base, last;
float weightAt(ivec2 corner, vec2 f, vec3 normal, float along) {
  vec4 receiver = texelFetch(receiver_normal, min(base + corner, last), 0);
  vec2 bilinear = mix(1.0 - f, f, vec2(corner));
  return max(bilinear.x * bilinear.y, kLeastBilinear) * receiverFitness(receiver, normal, along);
}
vec4 blended(int layer, vec4 w) {
  return w.x * texelFetch(field, ivec3(base, layer), 0) +
         w.y * texelFetch(field, ivec3(min(base + ivec2(1, 0), last), layer), 0) +
         w.z * texelFetch(field, ivec3(min(base + ivec2(0, 1), last), layer), 0) +
         w.w * texelFetch(field, ivec3(min(base + ivec2(1, 1), last), layer), 0);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(direct_full)))) return;
  float d = texelFetch(depth, pixel, 0).x;
  bool covered = d > 0.0;
  float along = eyeDepth(frame_view.view, covered ? d : 1.0);
  vec3 normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
  last = textureSize(receiver_normal, 0) - 1;
  vec2 at = receiverPlace(pixel, push.divisor);
  vec2 f = at - floor(at);
  base = ivec2(floor(at));
  f = mix(f, vec2(0.0), lessThan(base, ivec2(0)));  // beyond the first receiver
  base = clamp(base, ivec2(0), last);
  vec4 w = vec4(weightAt(ivec2(0, 0), f, normal, along), weightAt(ivec2(1, 0), f, normal, along),
                weightAt(ivec2(0, 1), f, normal, along), weightAt(ivec2(1, 1), f, normal, along));
  float total = w.x + w.y + w.z + w.w;
  if (covered && total < kPoorFit) {
    uint i = atomicAdd(repairs.list.count_and_one, 1u) - 1u;
    if (i < push.capacity) repairs.at[i] = uint(pixel.y) << 16 | uint(pixel.x);
    if (i > 0u && i < push.capacity && i % kRepairGroup == 0u) atomicAdd(repairs.list.groups_x, 1u);
  }
  w = total > 1e-20 ? w / total : vec4(0.25);
  vec4 a = blended(0, w), b = blended(1, w), c = blended(2, w);
  vec3 lit;
  if (whole_field) {
    vec4 e = blended(3, w);
    lit = irradianceThrough(
        float[16](a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z, c.w, e.x, e.y, e.z, e.w), normal);
  } else {
    vec4 n = vec4(normal, 1.0);
    lit = max(vec3(dot(a, n), dot(b, n), dot(c, n)), vec3(0.0));
  }
  vec3 sent = w.x * texelFetch(indirect, base, 0).rgb + w.y * texelFetch(indirect, min(base + ivec2(1, 0), last), 0).rgb +
              w.z * texelFetch(indirect, min(base + ivec2(0, 1), last), 0).rgb +
              w.w * texelFetch(indirect, min(base + ivec2(1, 1), last), 0).rgb;
  float shown = covered ? 1.0 : 0.0;
  imageStore(direct_full, pixel, vec4(lit * shown, 1.0));
  imageStore(indirect_full, pixel, vec4(sent * shown, 1.0));
}
