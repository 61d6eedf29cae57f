// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What one proxy sends to the receivers within its sphere of influence, to be added up by blending (PX-3 to PX-5, PX-7).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/proxies/proxies_shared.h"
#include "techniques/proxies/proxies_splat_push.glsl"
#define GLOAM_PROXIES_ONLY_INDIRECT

layout(constant_id = 0) const int indirect_kind = 2;
layout(constant_id = 1) const int exponential = 3;

layout(set = 0, binding = 2) uniform sampler2D receiver_position;
layout(set = 0, binding = 3) uniform sampler2D receiver_normal;
layout(scalar, set = 0, binding = 1) readonly buffer Proxies { ProxyRow at[]; } proxies;
layout(scalar, set = 0, binding = 4) readonly buffer OperatorTable { vec4 at[]; } operator_table;
layout(scalar, set = 0, binding = 5) readonly buffer AloneTable { float at[]; } alone_table;
layout(scalar, set = 0, binding = 6) uniform LightBlock { ProxyLight row; } light;

layout(location = 0) flat in uint proxy_index;
layout(location = 0) out vec4 sent;

#include "techniques/proxies/proxies_gather.glsl"

void main() {
  ivec2 place = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(receiver_position, place, 0);
  ProxyRow proxy = proxies.at[proxy_index];
  if (position.w <= 0.0 || !reaches(position.xyz, proxy)) discard;
  Gathered sum = Gathered(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  addProxy(sum, position.xyz, texelFetch(receiver_normal, place, 0).xyz, proxy, light.row.leaving);
  sent = sum.sent;
}
