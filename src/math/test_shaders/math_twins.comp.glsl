// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "math/brdf.glsl"
#include "math/sh_product.glsl"
#include "math/sh_product_high.glsl"
#include "math/test_shaders/math_twins_shared.h"
layout(local_size_x = 8) in;
layout(scalar, set = 0, binding = 0) readonly buffer Inputs { TwinInput inputs[]; };
layout(scalar, set = 0, binding = 1) writeonly buffer Outputs { TwinOutput outputs[]; };

// The first order^2 coefficients of the input's array. One loop of 36 rounds would not be unrolled by Mesa's software
// driver, which then compiles for minutes.
#define FIRST(type, name, source, order)   \
  type name[order * order];                \
  for (int a = 0; a < order; ++a) {        \
    for (int b = 0; b < order; ++b) name[order * a + b] = inputs[item].source[order * a + b]; \
  }

void main() {
  uint item = gl_GlobalInvocationID.x;
  if (item >= inputs.length()) return;
  vec3 direction = inputs[item].direction, normal = inputs[item].normal;
  float exponent = inputs[item].exponent;

  shEvaluate3(direction, outputs[item].basis3);
  shEvaluate6(direction, outputs[item].basis6);
  float zonal[5];
  for (int l = 0; l < 5; ++l) zonal[l] = inputs[item].f[l];
  shRotateZonal5(zonal, direction, outputs[item].zonal5);

  FIRST(float, f3, f, 3)
  FIRST(float, g3, g, 3)
  shProduct3(f3, g3, outputs[item].product3);
  FIRST(float, f4, f, 4)
  FIRST(float, g4, g, 4)
  shProduct4(f4, g4, outputs[item].product4);
  FIRST(float, f5, f, 5)
  FIRST(float, g5, g, 5)
  shProduct5(f5, g5, outputs[item].product5);
  FIRST(float, f6, f, 6)
  FIRST(float, g6, g, 6)
  shProduct6(f6, g6, outputs[item].product6);

  FIRST(vec3, light3, light, 3)
  FIRST(vec3, light4, light, 4)
  FIRST(vec3, light5, light, 5)
  FIRST(vec3, light6, light, 6)
  outputs[item].irradiance[0] = shIrradiance3(light3, normal);
  outputs[item].irradiance[1] = shIrradiance4(light4, normal);
  outputs[item].irradiance[2] = shIrradiance5(light5, normal);
  outputs[item].irradiance[3] = shIrradiance6(light6, normal);
  outputs[item].phong[0] = shadePhong3(light3, direction, exponent);
  outputs[item].phong[1] = shadePhong4(light4, direction, exponent);
  outputs[item].phong[2] = shadePhong5(light5, direction, exponent);
  outputs[item].phong[3] = shadePhong6(light6, direction, exponent);
  shConvolveCosine4(light4);
  outputs[item].cosine4 = light4;

  Lobes lobes = makeLobes(inputs[item].base_color, inputs[item].metallic, inputs[item].roughness, 1.0);
  outputs[item].lobes = evaluateLobes(lobes, normal, inputs[item].to_view, direction);
}
