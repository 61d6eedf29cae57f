// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gpu/test_shaders/gpu_test_shared.h"
layout(local_size_x = kGroupSize) in;
layout(scalar, set = 0, binding = 0) buffer Counter { uint count; } counter;

void main() { atomicAdd(counter.count, 1u); }
