// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Every virtual light at every pixel: what the multiresolution sum is held against. One chunk of lights a pass.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/splatting/splatting_light.glsl"

layout(constant_id = 0) const bool first = true;  // nothing to add to yet

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform VplBlock { VplRow at[kVplChunk]; } vpls;
layout(set = 0, binding = 1) uniform sampler2D receiver_position;
layout(set = 0, binding = 2) uniform sampler2D receiver_normal;
layout(set = 0, binding = 3, rgba32f) uniform image2D light;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(light)))) return;
  vec3 position = texelFetch(receiver_position, pixel, 0).xyz, normal = texelFetch(receiver_normal, pixel, 0).xyz;
  vec3 sum = first ? vec3(0.0) : imageLoad(light, pixel).rgb;
  // In halves, which drivers unroll: what is read at constant places of a block is read once for many invocations.
  for (int i = 0; i < kVplChunk / 2; ++i) addVpl(sum, vpls.at[i], position, normal);
  for (int i = 0; i < kVplChunk / 2; ++i) addVpl(sum, vpls.at[kVplChunk / 2 + i], position, normal);
  imageStore(light, pixel, vec4(sum, 1.0));
}
