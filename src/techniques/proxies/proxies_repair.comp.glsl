// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-8, the fix-up: pixels that no coarse receiver fits (silhouettes, thin things) are computed from scratch, with the
// proxies that reach their tile; those of a square of 2 x 2 on one surface at once, each at its own normal.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "frame/frame_shared.h"
#include "frame/gbuffer.glsl"
#include "frame/view.glsl"
#include "techniques/proxies/proxies_shared.h"

layout(constant_id = 0) const int indirect_kind = 2;
layout(constant_id = 1) const int exponential = 3;
layout(constant_id = 2) const bool normalise = true;
layout(constant_id = 3) const bool by_lanes = false;

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) uniform ViewBlock { FrameView view; } frame_view;
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(scalar, set = 0, binding = 3) readonly buffer Repairs { QuadList list; uint at[]; } repairs;
layout(scalar, set = 0, binding = 4) readonly buffer Proxies { uint at[]; } proxies;  // of ProxyRows
layout(scalar, set = 0, binding = 11) readonly buffer Bits { uint at[]; } bits;
layout(scalar, set = 0, binding = 12) readonly buffer Flats { uint at[]; } flats;      // of PatchRows
layout(scalar, set = 0, binding = 5) readonly buffer LogTable { vec4 at[]; } log_table;
layout(scalar, set = 0, binding = 6) readonly buffer OperatorTable { vec4 at[]; } operator_table;
layout(scalar, set = 0, binding = 10) readonly buffer AloneTable { float at[]; } alone_table;
layout(scalar, set = 0, binding = 7) uniform LightBlock { ProxyLight row; } light;
layout(set = 0, binding = 8, rgba16f) uniform image2D direct_full;  // A: how much of it is kept
layout(set = 0, binding = 9, rgba16f) uniform image2D indirect_full;
layout(scalar, push_constant) uniform Push { AccumulateParams params; uint columns; uint capacity; uint divisor; uint flats; } push;

#include "techniques/proxies/proxies_flats.glsl"
#include "techniques/proxies/proxies_quads.glsl"
#include "techniques/proxies/proxies_shade.glsl"
#include "techniques/proxies/proxies_tile_list.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  uint packed = i < min(repairs.list.count_and_one - 1u, push.capacity) ? repairs.at[i] : 0u;  // all lanes run
  ivec2 first = firstPixel(packed, push.divisor);
  Middle middle = middleOf(packed, first);
  uint tile = tileOf(first, push.columns);
  Gathered sum = gatherTile(middle.position, middle.normal, tile * push.params.words);
  float o[16];
  expOfLog(exponential, sum.log0, sum.log1, sum.log2, sum.log3, o);
  float share = normalise ? overlapShare(o[0], sum.sent.w) : 1.0;
  if (push.flats > 0u) {
    addFlats(push.flats, middle.position, middle.normal, sum.log0, sum.log1, sum.log2, sum.log3);
    expOfLog(exponential, sum.log0, sum.log1, sum.log2, sum.log3, o);
  }
  vec3 terms[9];
  shadeTerms(o, terms);
  vec3 peak = peakLeft(light.row.peak, o) * light.row.peak.irradiance, sent = max(sum.sent.rgb, vec3(0.0)) * share;
  for (uint k = 0u; k < 4u; ++k) {
    if ((packed >> k & 1u) == 0u) continue;
    ivec2 pixel = pixelOf(first, k);
    vec4 before = imageLoad(direct_full, pixel);
    vec3 normal = shadingNormal(texelFetch(normals, pixel, 0).xy);
    vec3 lit = max(irradianceOf(terms, normal), vec3(0.0)) + peak * max(0.0, dot(normal, light.row.peak.direction));
    imageStore(direct_full, pixel, vec4(mix(lit, before.rgb, before.a), 1.0));
    imageStore(indirect_full, pixel, vec4(mix(sent, imageLoad(indirect_full, pixel).rgb, before.a), 1.0));
  }
}
