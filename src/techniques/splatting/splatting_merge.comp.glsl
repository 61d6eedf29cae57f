// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Lights merged four by four (MS-9): flux and area of all at their mean, and how far from it they lie.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_shared.h"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 0) buffer Lights { SplatLight at[]; } lights;
layout(scalar, push_constant) uniform Push { uint from; uint from_count; uint to; uint to_count; } push;  // rows

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= push.to_count) return;
  SplatLight sum = SplatLight(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
  for (uint i = 0u; i < 4u; ++i) {
    uint row = 4u * index + i;
    if (row >= push.from_count) break;
    SplatLight light = lights.at[push.from + row];
    sum.position += light.power * light.position;
    sum.normal += light.power * light.normal;
    sum.intensity += light.intensity;
    sum.bound += light.bound;
    sum.power += light.power;
  }
  float scale = sum.power > 0.0 ? 1.0 / sum.power : 0.0;
  sum.position *= scale;
  sum.normal *= scale;
  for (uint i = 0u; i < 4u; ++i) {
    uint row = 4u * index + i;
    if (row >= push.from_count) break;
    SplatLight light = lights.at[push.from + row];
    vec3 off = light.position - sum.position;
    sum.spread += light.power * scale * (dot(off, off) + light.spread * light.spread);
  }
  sum.spread = sqrt(sum.spread);
  lights.at[push.to + index] = sum;
}
