// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Is a point in the light of a lamp? Percentage-closer filtering (Reeves, Salesin, Cook 1987) over 4 x 4
// texels, a box of 3 texels smoothed by the fraction of a texel.
//
// Every tap is compared with the depth that the receiver's own plane has at the middle of that texel, which
// needs no bias on flat surfaces; in a perspective map the inverse of the depth is linear over the map, in an
// orthographic one the depth. What remains (curved surfaces, rounding) is left to a step of one texel along
// the normal: contact shadows begin within a texel of the contact.
#ifndef GLOAM_FRAME_SHADOW_GLSL
#define GLOAM_FRAME_SHADOW_GLSL
#include "frame/frame_shared.h"

/// Steepest plane that taps follow, in depth over width; beyond, grazing light would see through what stands
/// before it.
const float kSteepestPlane = 16.0;

/// In which of a lamp's six maps a direction lies: +X -X +Y -Y +Z -Z.
uint cubeFace(vec3 direction) {
  vec3 a = abs(direction);
  if (a.x >= a.y && a.x >= a.z) return direction.x >= 0.0 ? 0u : 1u;
  if (a.y >= a.z) return direction.y >= 0.0 ? 2u : 3u;
  return direction.z >= 0.0 ? 4u : 5u;
}

/// Depth of the receiver's plane over the map, as the map stores it: dot(slope, (x, y, 1)) at place (x, y) of
/// the map (tangents, or metres where orthographic), kept between low and high.
struct PlaneDepth {
  vec3 slope;
  float low, high;
};

/// `n` and `p` in the map's axes (right, up, forward); the plane faces the lamp.
PlaneDepth planeDepth(ShadowView view, vec3 n, vec3 p, float reach) {
  if (view.depth_range > 0.0) {
    vec3 slope = vec3(n.xy / n.z, -dot(n, p) / n.z) / view.depth_range;
    slope.z += 1.0;
    return PlaneDepth(slope, 1.0 - (p.z + reach) / view.depth_range, 1.0 - (p.z - reach) / view.depth_range);
  }
  return PlaneDepth(view.z_near * n / dot(n, p), view.z_near / (p.z + reach), view.z_near / max(p.z - reach, 0.5 * p.z));
}

/// Lit share of four texels, weighted; in the order of textureGather: (x0, y1) (x1, y1) (x1, y0) (x0, y0).
float litTexels(PlaneDepth plane, vec2 xs, vec2 ys, vec2 weights_x, vec2 weights_y, vec4 nearest) {
  vec4 own = clamp(plane.slope.x * xs.xyyx + plane.slope.y * ys.yyxx + plane.slope.z, plane.low, plane.high);
  return dot(vec4(greaterThanEqual(own, nearest)), weights_x.xyyx * weights_y.yyxx);
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
  vec2 t = orthographic ? p.xy : p.xy / p.z;
  vec2 place = (t / half_size * vec2(0.5, -0.5) + 0.5) * size - 0.5;
  bool outside = any(lessThan(place, vec2(-1.0))) || any(greaterThan(place, vec2(size)));
  if (outside || (!orthographic && p.z <= view.z_near)) return 1.0;  // nothing was drawn there

  PlaneDepth plane = planeDepth(view, n, p, kSteepestPlane * 2.0 * texel);
  vec2 base = floor(place), f = place - base;
  vec4 columns = clamp(base.x + vec4(-1.0, 0.0, 1.0, 2.0), 0.0, size - 1.0);
  vec4 rows = clamp(base.y + vec4(-1.0, 0.0, 1.0, 2.0), 0.0, size - 1.0);
  vec4 xs = ((columns + 0.5) / size * 2.0 - 1.0) * half_size.x;
  vec4 ys = (1.0 - (rows + 0.5) / size * 2.0) * half_size.y;
  vec4 weights_x = vec4(1.0 - f.x, 1.0, 1.0, f.x), weights_y = vec4(1.0 - f.y, 1.0, 1.0, f.y);
  vec3 corner = vec3(base / size, float(layer));  // between the first and second column and row
  float two = 2.0 / size;
  float lit = litTexels(plane, xs.xy, ys.xy, weights_x.xy, weights_y.xy, textureGather(maps, corner));
  lit += litTexels(plane, xs.zw, ys.xy, weights_x.zw, weights_y.xy, textureGather(maps, corner + vec3(two, 0.0, 0.0)));
  lit += litTexels(plane, xs.xy, ys.zw, weights_x.xy, weights_y.zw, textureGather(maps, corner + vec3(0.0, two, 0.0)));
  lit += litTexels(plane, xs.zw, ys.zw, weights_x.zw, weights_y.zw, textureGather(maps, corner + vec3(two, two, 0.0)));
  return lit / 9.0;
}

#endif
