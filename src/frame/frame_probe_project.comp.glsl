// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One face of a probe's cube in spherical harmonics (SH-2): each texel times the integrals of the basis functions over it.
// A lane is a coefficient.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/probe_shared.h"

layout(local_size_x = 40) in;
layout(scalar, set = 0, binding = 0) readonly buffer Table { float at[]; } table;
layout(set = 0, binding = 1) uniform sampler2D emitted;
layout(set = 0, binding = 2) uniform sampler2D reflected;
layout(scalar, set = 0, binding = 3) writeonly buffer Sums { ProbeSums at[]; } sums;
layout(scalar, push_constant) uniform Push { uint size; } push;

void main() {
  uint lane = gl_LocalInvocationID.x, face = gl_WorkGroupID.y, probe = gl_WorkGroupID.x;
  ivec2 corner = ivec2(face, probe) * int(push.size);
  uint at = face * push.size * push.size * kProbeStride + lane;
  bool is_coefficient = lane < kProbeSolidAngle;
  ProbeSums sum = ProbeSums(vec3(0.0), vec3(0.0));
  for (int y = 0; y < int(push.size); ++y) {
    for (int x = 0; x < int(push.size); ++x) {
      vec4 e = texelFetch(emitted, corner + ivec2(x, y), 0), r = texelFetch(reflected, corner + ivec2(x, y), 0);
      vec3 shares = vec3((1.0 - e.a) * dot(e.rgb, vec3(0.2126, 0.7152, 0.0722)), r.a, e.a);
      float weight = table.at[at];
      sum.emitted += weight * (is_coefficient ? e.rgb : shares);
      sum.reflected += weight * r.rgb;
      at += kProbeStride;
    }
  }
  sums.at[(probe * 6u + face) * kProbeStride + lane] = sum;
}
