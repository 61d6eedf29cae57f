// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a pixel keeps, read back: halves over weight and exposure (radiance_filter_shared.h).
#ifndef GLOAM_RADIANCE_FILTER_VALUES_GLSL
#define GLOAM_RADIANCE_FILTER_VALUES_GLSL
#include "techniques/radiance_filter/radiance_filter_shared.h"

layout(constant_id = 0) const bool field = true;

layout(set = 0, binding = 0) uniform sampler2DArray values;
layout(scalar, set = 0, binding = 1) readonly buffer Exposure { float at[]; } exposure;

vec4 valuesAt(ivec2 pixel, int part, int layer) {
  return texelFetch(values, ivec3(pixel, part * (field ? kFieldLayers : kLobeLayers) + layer), 0);
}

/// Share of the window that was taken.
float weightAt(ivec2 pixel, int part) { return valuesAt(pixel, part, (field ? kFieldLayers : kLobeLayers) - 1).a; }

float scaleOf(float weight) { return weight > 0.0 ? 1.0 / (weight * exposure.at[0]) : 0.0; }

void readField(out vec3 light[9], ivec2 pixel, int part) {
  vec4 a = valuesAt(pixel, part, 0), b = valuesAt(pixel, part, 1), c = valuesAt(pixel, part, 2), d = valuesAt(pixel, part, 3),
       e = valuesAt(pixel, part, 4), f = valuesAt(pixel, part, 5), g = valuesAt(pixel, part, 6);
  float scale = scaleOf(g.a);
  light = vec3[9](a.rgb, vec3(a.a, b.rg), vec3(b.ba, c.r), c.gba, d.rgb, vec3(d.a, e.rg), vec3(e.ba, f.r), f.gba, g.rgb);
  for (int i = 0; i < 9; ++i) light[i] *= scale;
}

void readLobes(out vec3 irradiance_, out vec3 gloss_, ivec2 pixel, int part) {
  vec4 a = valuesAt(pixel, part, 0), b = valuesAt(pixel, part, 1);
  irradiance_ = scaleOf(b.a) * a.rgb;
  gloss_ = scaleOf(b.a) * vec3(a.a, b.rg);
}

#endif
