// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gpu/test_shaders/gpu_test_shared.h"
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 0, r32f) uniform writeonly image3D volume;

void main() {
  const ivec3 texel = ivec3(gl_GlobalInvocationID);
  if (all(lessThan(texel, imageSize(volume)))) imageStore(volume, texel, vec4(float(texel.z)));
}
