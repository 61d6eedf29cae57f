// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gpu/test_shaders/gpu_test_shared.h"
layout(constant_id = 0) const bool kInvert = false;
layout(set = 1, binding = 0) uniform sampler2D base_color;
layout(location = 0) in vec2 uv;
layout(location = 1) out vec4 out_color;
layout(location = 0) out uint out_id;

void main() {
  const vec4 color = texture(base_color, uv);
  out_color = kInvert ? vec4(1.0 - color.rgb, 1.0) : color;
  out_id = 1u + uint(gl_PrimitiveID);
}
