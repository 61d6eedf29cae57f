// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Is a point in the light of a lamp? Percentage-closer filtering (Reeves, Salesin, Cook 1987) over 4 x 4 texels, a box of 3
// texels smoothed by the fraction of a texel.
//
// Every tap is compared with the depth that the receiver's own plane has at the middle of that texel, which needs no bias on
// flat surfaces; in a perspective map the inverse of the depth is linear over the map, in an orthographic one the depth.
// What remains (curved surfaces, rounding) is left to a step of one texel along the normal: contact shadows begin within
// a texel of the contact.
#ifndef GLOAM_FRAME_SHADOW_GLSL
#define GLOAM_FRAME_SHADOW_GLSL
#include "frame/frame_shared.h"

/// Steepest plane that taps follow, in depth over width; beyond, grazing light would see through what stands before it.
const float kSteepestPlane = 16.0;

/// In which of a lamp's six maps a direction lies: +X -X +Y -Y +Z -Z.
uint cubeFace(vec3 direction) {
  vec3 a = abs(direction);
  if (a.x >= a.y && a.x >= a.z) return direction.x >= 0.0 ? 0u : 1u;
  if (a.y >= a.z) return direction.y >= 0.0 ? 2u : 3u;
  return direction.z >= 0.0 ? 4u : 5u;
}

/// Depth of the receiver's plane at place t of the map (tangents, or metres where orthographic), as the map stores it.
/// `n` and `p` in the map's axes (right, up, forward).
float planeDepth(ShadowView view, vec3 n, vec3 p, vec2 t, float reach) {
  if (view.depth_range > 0.0) {
    float z = p.z - dot(n.xy, t - p.xy) / n.z;  // n.z < 0: the plane faces the lamp
    return 1.0 - clamp(z, p.z - reach, p.z + reach) / view.depth_range;
  }
  float inverse_z = dot(n, vec3(t, 1.0)) / dot(n, p);
  return view.z_near * clamp(inverse_z, 1.0 / (p.z + reach), 1.0 / max(p.z - reach, 0.5 * p.z));
}

/// Share of the light that arrives, 0 to 1. `normal`: geometric, on the lamp's side of the surface.
float shadowFactor(ShadowView view, sampler2DArray maps, int layer, vec3 position, vec3 normal) {
  float size = float(textureSize(maps, 0).x);
  bool orthographic = view.depth_range > 0.0;
  vec3 n = vec3(dot(normal, view.right), dot(normal, view.up), dot(normal, view.forward));
  vec3 from = position - view.origin;
  vec3 p = vec3(dot(from, view.right), dot(from, view.up), dot(from, view.forward));
  vec2 half_size = vec2(view.half_width, view.half_height);
  float texel = 2.0 * max(half_size.x, half_size.y) / size * (orthographic ? 1.0 : p.z);
  p += texel * n;
  if (!orthographic && p.z <= view.z_near) return 1.0;

  vec2 t = orthographic ? p.xy : p.xy / p.z;
  vec2 place = (t / half_size * vec2(0.5, -0.5) + 0.5) * size - 0.5;
  if (any(lessThan(place, vec2(-1.0))) || any(greaterThan(place, vec2(size)))) return 1.0;  // outside: nothing drawn
  vec2 base = floor(place), f = place - base;
  float reach = kSteepestPlane * 2.0 * texel;
  vec4 weight_x = vec4(1.0 - f.x, 1.0, 1.0, f.x), weight_y = vec4(1.0 - f.y, 1.0, 1.0, f.y);
  float lit = 0.0;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      ivec2 tap = clamp(ivec2(base) + ivec2(x - 1, y - 1), ivec2(0), ivec2(size) - 1);
      vec2 tap_t = ((vec2(tap) + 0.5) / size * 2.0 - 1.0) * vec2(half_size.x, -half_size.y);
      float nearest = texelFetch(maps, ivec3(tap, layer), 0).x;
      lit += planeDepth(view, n, p, tap_t, reach) >= nearest ? weight_x[x] * weight_y[y] : 0.0;
    }
  }
  return lit / 9.0;
}

#endif
