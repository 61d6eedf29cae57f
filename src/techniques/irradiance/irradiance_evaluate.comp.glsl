// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// E(n) = sum of sh[i] y_i(n) at every pixel's shading normal; never negative.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/gbuffer.glsl"
#include "frame/sh_value.glsl"
#include "techniques/irradiance/irradiance_shared.h"

layout(constant_id = 0) const int order = 3;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform LightBlock { IrradianceRow row; } light;
layout(set = 0, binding = 1) uniform usampler2D ids;
layout(set = 0, binding = 2) uniform usampler2D normals;
layout(set = 0, binding = 3) uniform writeonly image2D irradiance;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(irradiance)))) return;
  vec3 sum = vec3(0.0);
  if (isCovered(texelFetch(ids, pixel, 0).xy))
    sum = shValue(order, light.row.sh, shadingNormal(texelFetch(normals, pixel, 0).xy));
  imageStore(irradiance, pixel, vec4(max(sum, vec3(0.0)), 1.0));
}
