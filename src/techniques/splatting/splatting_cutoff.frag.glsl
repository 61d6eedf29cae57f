// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Dachsbacher, Stamminger 2006, "Splatting indirect illumination": one virtual light at the pixels within its radius, to be added
// up by blending. What is farther gets nothing of it: the smaller the radius, the faster and the darker.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_light.glsl"

layout(scalar, set = 0, binding = 1) readonly buffer Vpls { VplRow at[]; } vpls;
layout(set = 0, binding = 2) uniform sampler2D receiver_position;
layout(set = 0, binding = 3) uniform sampler2D receiver_normal;
layout(scalar, push_constant) uniform Push { float radius; } push;

layout(location = 0) flat in uint vpl_index;
layout(location = 0) out vec4 light;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(receiver_position, pixel, 0);
  VplRow vpl = vpls.at[vpl_index];
  if (position.w <= 0.0 || distance(position.xyz, vpl.position) > push.radius) discard;
  vec3 sum = vec3(0.0);
  addVpl(sum, vpl, position.xyz, texelFetch(receiver_normal, pixel, 0).xyz);
  light = vec4(sum, 0.0);
}
