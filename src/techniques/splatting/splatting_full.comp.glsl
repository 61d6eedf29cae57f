// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Every virtual light at every pixel: what the multiresolution sum is held against. One chunk of lights a pass, by the same sum of
// four receivers at once.
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

void add(inout Gathered sum, VplRow vpl, Receivers at) {
  addLight(sum, SplatLight(vpl.position, vpl.bound, vpl.normal, 0.0, vpl.intensity, 0.0), at, vec4(1.0), false, false);
}

void main() {
  ivec2 pixel = ivec2(kEach, 1) * ivec2(gl_GlobalInvocationID.xy), size = imageSize(light);
  if (any(greaterThanEqual(pixel, size))) return;
  Receivers at;
  Gathered sum = Gathered(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  for (int i = 0; i < kEach; ++i) {
    ivec2 place = ivec2(min(pixel.x + i, size.x - 1), pixel.y);
    vec3 position = texelFetch(receiver_position, place, 0).xyz, normal = texelFetch(receiver_normal, place, 0).xyz;
    at.x[i] = position.x;
    at.y[i] = position.y;
    at.z[i] = position.z;
    at.normal_x[i] = normal.x;
    at.normal_y[i] = normal.y;
    at.normal_z[i] = normal.z;
    if (!first) {
      vec3 before = imageLoad(light, place).rgb;
      sum.red[i] = before.r;
      sum.green[i] = before.g;
      sum.blue[i] = before.b;
    }
  }
  // In halves, which drivers unroll: what is read at constant places of a block is read once for many invocations.
  for (int i = 0; i < kVplChunk / 2; ++i) add(sum, vpls.at[i], at);
  for (int i = 0; i < kVplChunk / 2; ++i) add(sum, vpls.at[kVplChunk / 2 + i], at);
  for (int i = 0; i < kEach; ++i) {
    if (pixel.x + i < size.x) imageStore(light, pixel + ivec2(i, 0), vec4(sum.red[i], sum.green[i], sum.blue[i], 1.0));
  }
}
