// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gpu/test_shaders/gpu_test_shared.h"
layout(local_size_x = 32, local_size_x_id = 0) in;
layout(constant_id = 1) const uint kMode = 7;
layout(constant_id = 2) const float kScale = 0.5;
layout(constant_id = 3) const bool kNegate = false;
layout(constant_id = 0) const uint kWidth = 32;
layout(scalar, set = 0, binding = 0) writeonly buffer Out { float values[]; } result;

void main() {
  const float value = float(kMode) * kScale * (kNegate ? -1.0 : 1.0);
  if (gl_LocalInvocationID.x == 0) result.values[gl_WorkGroupID.x] = value + 1000.0 * float(kWidth);
}
