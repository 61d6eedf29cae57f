// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gpu/test_shaders/gpu_test_shared.h"
layout(local_size_x = 1) in;
layout(scalar, set = 0, binding = 0) writeonly buffer Arguments { uvec3 groups; } arguments;
layout(scalar, push_constant) uniform Push { CountParams params; };

void main() { arguments.groups = uvec3(params.count, 1, 1); }
