// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gpu/test_shaders/gpu_test_shared.h"
layout(location = 0) in vec3 position;
void main() { gl_Position = vec4(position, 1.0); }
