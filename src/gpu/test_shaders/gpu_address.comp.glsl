// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gpu/test_shaders/gpu_test_shared.h"
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = kGroupSize) in;
layout(scalar, buffer_reference, buffer_reference_align = 4) buffer Floats { float values[]; };
layout(scalar, push_constant) uniform Push { uvec2 from; uvec2 to; uint count; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < count) Floats(to).values[i] = Floats(from).values[i] + 0.5;
}
