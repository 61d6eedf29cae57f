// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Log visibility of one proxy at the receivers within its sphere of influence, to be added up by blending (PX-1, PX-7).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/proxies/proxies_shared.h"
#include "techniques/proxies/proxies_splat_push.glsl"
#define GLOAM_PROXIES_ONLY_SHADOW

layout(set = 0, binding = 2) uniform sampler2D receiver_position;
layout(set = 0, binding = 3) uniform sampler2D receiver_normal;
layout(scalar, set = 0, binding = 1) readonly buffer Proxies { ProxyRow at[]; } proxies;
layout(scalar, set = 0, binding = 4) readonly buffer LogTable { vec4 at[]; } log_table;

layout(location = 0) flat in uint proxy_index;
layout(location = 0) out vec4 log0;
layout(location = 1) out vec4 log1;
layout(location = 2) out vec4 log2;
layout(location = 3) out vec4 log3;

#include "techniques/proxies/proxies_gather.glsl"

void main() {
  ivec2 place = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(receiver_position, place, 0);
  ProxyRow proxy = proxies.at[proxy_index];
  if (position.w <= 0.0 || !reaches(position.xyz, proxy)) discard;
  vec3 nothing[9];  // no light is asked for
  Gathered sum = Gathered(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  addProxy(sum, position.xyz, texelFetch(receiver_normal, place, 0).xyz, proxy, nothing);
  log0 = sum.log0, log1 = sum.log1, log2 = sum.log2, log3 = sum.log3;
}
