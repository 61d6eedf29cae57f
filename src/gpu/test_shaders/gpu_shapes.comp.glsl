// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gpu/test_shaders/gpu_test_shared.h"
// Reads a cube, a 3D image, an array of depth images through a comparison, and integers.
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform samplerCube cube;
layout(set = 0, binding = 1) uniform sampler3D volume;
layout(set = 0, binding = 2) uniform sampler2DArrayShadow shadow;
layout(set = 0, binding = 3) uniform usampler2D ids;
layout(scalar, set = 0, binding = 4) writeonly buffer Out { float values[]; } result;

void main() {
  const vec3 axes[6] = {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1)};
  for (int i = 0; i < 6; ++i) result.values[i] = textureLod(cube, axes[i], 0.0).x;
  result.values[6] = textureLod(volume, vec3(0.5, 0.5, 0.5), 0.0).x;
  result.values[7] = texture(shadow, vec4(0.5, 0.5, 0.0, 0.4));
  result.values[8] = texture(shadow, vec4(0.5, 0.5, 1.0, 0.4));
  result.values[9] = float(texelFetch(ids, ivec2(0), 0).x);
}
