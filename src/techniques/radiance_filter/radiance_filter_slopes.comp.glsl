// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Beside edges a window lies to one side of its pixel, and its mean is the light there, not here. Two whole windows further on tell the slope, by which light
// is carried back to the pixel. Whole windows stay as they are, so each pixel may be written where it stands.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "math/sh.glsl"

layout(constant_id = 1) const int taps = 4;    // of the longer side
layout(constant_id = 2) const int layers = 7;  // of a part
layout(constant_id = 3) const int parts = 1;

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 4) readonly buffer Shifts { vec2 at[]; } shifts;
layout(set = 0, binding = 5, rgba16f) uniform image2DArray means;

#include "techniques/radiance_filter/radiance_filter_window.glsl"

/// By what a whole window's mean is multiplied to stand for as much as `weight`.
float scaleAt(ivec2 pixel, int last, float weight) { return weight / max(imageLoad(means, ivec3(pixel, last)).a, 1e-6); }

/// What a part's mean there gives a surface: irradiance over pi, of a field in two bands.
vec3 lightAt(ivec2 pixel, int first, float y[4]) {
  vec4 a = imageLoad(means, ivec3(pixel, first));
  if (layers != kFieldLayers) return a.rgb;
  vec4 b = imageLoad(means, ivec3(pixel, first + 1)), c = imageLoad(means, ivec3(pixel, first + 2));
  return a.rgb * y[0] + (2.0 / 3.0) * (vec3(a.a, b.rg) * y[1] + vec3(b.ba, c.r) * y[2] + c.gba * y[3]);
}

/// How much of a slope is followed: none at steps and turns, all where it goes on (a limiter, after van Leer 1977).
float slopeShare(float slope, float beyond) { return slope * beyond > 0.0 ? min(1.0, kSteepest * beyond / slope) : 0.0; }

void main() {
  ivec2 size = ivec2(push.limits.width, push.limits.height), pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size))) return;
  vec2 shift = shifts.at[pixel.y * size.x + pixel.x];
  float off = length(shift);
  if (off < kLeastShift || shift.x == kNoShift) return;
  Surface middle = surfaceAt(pixel, size);
  float tolerance = toleranceAt(middle.position), span = 0.0;
  ivec2 near = pixel, far = pixel;
  for (int k = 0; k < 2 && span == 0.0; ++k) {
    int wanted = k == 0 ? taps + taps / 2 : taps;
    near = pixel + ivec2(roundEven(shift * (float(wanted) / off)));
    far = 2 * near - pixel;
    if (any(lessThan(far, ivec2(0))) || any(greaterThanEqual(far, size))) continue;
    if (shifts.at[near.y * size.x + near.x] != vec2(0.0) || shifts.at[far.y * size.x + far.x] != vec2(0.0)) continue;
    if (isSameSurface(middle, tolerance, surfaceAt(near, size)) && isSameSurface(middle, tolerance, surfaceAt(far, size)))
      span = dot(vec2(near - pixel), shift / off);
  }
  if (!(span > off)) return;
  float y[4];
  shEvaluate2(middle.normal, y);
  for (int part = 0; part < parts; ++part) {
    int first = part * layers, last = first + layers - 1;
    float weight = imageLoad(means, ivec3(pixel, last)).a, near_scale = scaleAt(near, last, weight);
    vec3 here = lightAt(pixel, first, y), there = near_scale * lightAt(near, first, y), way = here - there;
    float slope = dot(way, vec3(1.0)) / (span - off),
          beyond = dot(there - scaleAt(far, last, weight) * lightAt(far, first, y), vec3(1.0)) / span;
    float share = slopeShare(slope, beyond) * off / (span - off);
    for (int c = 0; c < 3; ++c)
      if (share * way[c] < (kLeastLeft - 1.0) * here[c]) share = (kLeastLeft - 1.0) * max(0.0, here[c]) / way[c];
    if (share == 0.0) continue;
    for (int l = first; l <= last; ++l) {
      vec4 own = imageLoad(means, ivec3(pixel, l)), light = own + share * (own - near_scale * imageLoad(means, ivec3(near, l)));
      imageStore(means, ivec3(pixel, l), vec4(light.rgb, l == last ? own.a : light.a));
    }
  }
}
