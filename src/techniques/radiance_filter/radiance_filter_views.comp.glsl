// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pictures of what a pixel keeps, of all parts together: the length of a band's coefficients (band 0: the mean radiance, times
// sqrt(4 pi)), or irradiance and gloss; its share of the window; its set, red across and green down.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "techniques/radiance_filter/radiance_filter_values.glsl"

layout(constant_id = 1) const int band = 0;  // 3: weights, 4: set; of lobes 0 irradiance, 1 gloss
layout(constant_id = 2) const int parts = 1;

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 2) uniform writeonly image2D view;
layout(scalar, push_constant) uniform Push { uvec2 sets; } push;

vec3 bandOf(ivec2 pixel) {
  vec3 light[9], sum[9];
  readField(sum, pixel, 0);
  for (int part = 1; part < parts; ++part) {
    readField(light, pixel, part);
    for (int i = 0; i < 9; ++i) sum[i] += light[i];
  }
  vec3 squared = vec3(0.0);
  for (int i = 0; i < 9; ++i)
    if (i >= band * band && i < (band + 1) * (band + 1)) squared += sum[i] * sum[i];
  return sqrt(squared);
}

vec3 lobeOf(ivec2 pixel) {
  vec3 sum = vec3(0.0);
  for (int part = 0; part < parts; ++part) {
    vec3 irradiance_, gloss_;
    readLobes(irradiance_, gloss_, pixel, part);
    sum += band == 0 ? irradiance_ : gloss_;
  }
  return sum;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(view)))) return;
  vec3 shown;
  if (band == 4) {
    shown = vec3((vec2(uvec2(pixel) % push.sets) + 0.5) / vec2(push.sets), 0.0);
  } else if (band == 3) {
    shown = vec3(weightAt(pixel, 0));
  } else {
    shown = field ? bandOf(pixel) : lobeOf(pixel);
  }
  imageStore(view, pixel, vec4(min(shown, vec3(65504.0)), 1.0));
}
