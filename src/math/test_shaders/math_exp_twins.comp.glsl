// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "math/sh_exp_high.glsl"
#include "math/sh_log_blocker.glsl"
#include "math/test_shaders/math_exp_twins_shared.h"
layout(local_size_x = 8) in;
layout(scalar, set = 0, binding = 0) readonly buffer Inputs { ExpTwinInput inputs[]; };
layout(scalar, set = 0, binding = 1) writeonly buffer Outputs { ExpTwinOutput outputs[]; };

#define FIRST(name, order)                 \
  float name[order * order];               \
  for (int a = 0; a < order; ++a) {        \
    for (int b = 0; b < order; ++b) name[order * a + b] = inputs[item].f[order * a + b]; \
  }

void main() {
  uint item = gl_GlobalInvocationID.x;
  if (item >= inputs.length()) return;
  FIRST(f3, 3)
  FIRST(f4, 4)
  FIRST(f5, 5)
  FIRST(f6, 6)
  shExpHybrid3(f3, outputs[item].hybrid3);
  shExpHybrid4(f4, outputs[item].hybrid4);
  shExpHybrid5(f5, outputs[item].hybrid5);
  shExpHybrid6(f6, outputs[item].hybrid6);
  shExpQuadratic3(f3, outputs[item].quadratic3);
  shExpQuadratic4(f4, outputs[item].quadratic4);
  shExpQuadratic5(f5, outputs[item].quadratic5);
  shExpQuadratic6(f6, outputs[item].quadratic6);
  shExpLinear4(f4, outputs[item].linear4);
  shExpSeries4(f4, 9, outputs[item].series4);
  outputs[item].coordinate = shLogBlockerCoordinate(inputs[item].alpha);
  outputs[item].alpha = shLogBlockerAlpha(shLogBlockerCoordinate(inputs[item].alpha));
}
