// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gpu/test_shaders/gpu_test_shared.h"
layout(scalar, set = 0, binding = 0) readonly buffer Positions { vec3 positions[]; };
layout(scalar, push_constant) uniform Push { vec2 shift; };
layout(location = 0) out vec2 uv;

void main() {
  const vec3 position = positions[gl_VertexIndex];
  uv = position.xy * 0.5 + 0.5;
  gl_Position = vec4(position.xy + shift, position.z, 1.0);
}
