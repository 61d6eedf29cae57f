// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "gpu/test_shaders/gpu_test_shared.h"
layout(local_size_x = 1) in;
layout(scalar, set = 0, binding = 0) readonly buffer Records { Record records[]; };
layout(scalar, set = 0, binding = 1) uniform One { Record one; } uniform_record;
layout(scalar, set = 0, binding = 2) writeonly buffer Out { float values[]; } result;

float sum(Record r) {
  return r.position.z + 10.0 * r.uv.y + 100.0 * r.frame[2].z + 1000.0 * r.inner[1].radius +
         10000.0 * float(r.inner[1].ids.y) + 100000.0 * float(r.flags) + r.world_from_object[3].w;
}

void main() {
  result.values[0] = sum(records[0]);
  result.values[1] = sum(records[1]);
  result.values[2] = sum(uniform_record.one);
}
