// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-8, the fix-up: pixels that no coarse receiver fits (silhouettes, thin things) are computed from scratch, with the
// proxies that reach their tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "techniques/proxies/proxies_shared.h"

layout(constant_id = 0) const int indirect_kind = 2;
layout(constant_id = 1) const int exponential = 3;
layout(constant_id = 2) const bool normalise = true;

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(scalar, set = 0, binding = 3) readonly buffer Repairs { RepairList list; uint at[]; } repairs;
layout(scalar, set = 0, binding = 4) readonly buffer Proxies { ProxyRow at[]; } proxies;
layout(scalar, set = 0, binding = 11) readonly buffer Bits { uint at[]; } bits;
layout(scalar, set = 0, binding = 5) readonly buffer LogTable { vec4 at[]; } log_table;
layout(scalar, set = 0, binding = 6) readonly buffer OperatorTable { vec4 at[]; } operator_table;
layout(scalar, set = 0, binding = 10) readonly buffer AloneTable { float at[]; } alone_table;
layout(scalar, set = 0, binding = 7) uniform LightBlock { ProxyLight row; } light;
layout(set = 0, binding = 8, rgba16f) uniform image2D direct_full;  // A: how much of it is kept
layout(set = 0, binding = 9, rgba16f) uniform image2D indirect_full;
layout(scalar, push_constant) uniform Push { AccumulateParams params; uint columns; uint capacity; } push;

#include "techniques/proxies/proxies_shade.glsl"
#include "techniques/proxies/proxies_tile_list.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= min(repairs.list.count_and_one - 1u, push.capacity)) return;
  uint packed = repairs.at[i];
  ivec2 pixel = ivec2(packed & 0xffffu, packed >> 16);
  Ray ray = pixelRay(frame_view.view, vec2(pixel) + 0.5);
  vec3 position = ray.origin + ray.direction * eyeDepth(frame_view.view, texelFetch(depth, pixel, 0).x);
  vec3 normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
  uvec2 tile = uvec2(pixel) / kRepairTile;
  Gathered sum = gatherTile(position, normal, (tile.y * push.columns + tile.x) * push.params.words);
  float o[16];
  expOfLog(exponential, sum.log0, sum.log1, sum.log2, sum.log3, o);
  float share = normalise ? overlapShare(o[0], sum.sent.w) : 1.0;
  vec4 before = imageLoad(direct_full, pixel);
  vec3 lit = mix(irradianceThrough(o, normal), before.rgb, before.a);
  vec3 sent = mix(max(sum.sent.rgb, vec3(0.0)) * share, imageLoad(indirect_full, pixel).rgb, before.a);
  imageStore(direct_full, pixel, vec4(lit, 1.0));
  imageStore(indirect_full, pixel, vec4(sent, 1.0));
}
