// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Rectangles of what has no spheres (ground, walls), as a point sees them. What one of radiance 1 sends to a point is exact (Lambert): its
// vector irradiance is half the sum over edges of the angle that they subtend times the unit normal of the plane through edge and
// point. As a blocker it is the cone of the same vector irradiance, pi sin^2.
#ifndef GLOAM_FRAME_PATCH_GLSL
#define GLOAM_FRAME_PATCH_GLSL
#include "frame/patch_shared.h"

vec3 wayTo(vec3 d) { return d * inversesqrt(max(dot(d, d), 1e-24)); }
/// angle / sin(angle) between two unit vectors times their cross product. The factor is a polynomial over the cosine (least largest
/// error, 2e-5), and for the obtuse the one of the rest to pi.
vec3 edgeTerm(vec3 a, vec3 b) {
  float x = dot(a, b), y = abs(x);
  float f = ((((-0.0693367306 * y + 0.281867207) * y - 0.547124648) * y + 0.762052962) * y - 0.998255165) * y + 1.57077493;
  return (x < 0.0 ? 3.14159265 * inversesqrt(max(1.0 - y * y, 1e-12)) - f : f) * cross(a, b);
}

/// Toward the patch, at most pi long; height: of the point over its plane.
vec3 patchVector(PatchRow row, vec3 position, out float height) {
  vec3 c = row.center - position;
  vec3 r0 = wayTo(c - row.half_u - row.half_v), r1 = wayTo(c + row.half_u - row.half_v);
  vec3 r2 = wayTo(c + row.half_u + row.half_v), r3 = wayTo(c - row.half_u + row.half_v);
  vec3 sum = 0.5 * (edgeTerm(r0, r1) + edgeTerm(r1, r2) + edgeTerm(r2, r3) + edgeTerm(r3, r0));
  height = -dot(c, row.normal);
  return (dot(sum, row.normal) > 0.0) == (height >= 0.0) ? -sum : sum;
}

/// What lies along a surface is not seen from it.
const float kTangent = 1e-3;  // of a patch's size
/// Clipped to the tangent plane: between two corners, of which one at least is above it.
struct Clipped {
  float sum;
  vec3 last, first;  // where the outline goes below and comes back
};
void addEdge(inout Clipped clipped, vec3 a, vec3 b, vec3 normal, float lift) {
  float from = dot(a, normal) - lift, to = dot(b, normal) - lift;
  if (max(from, to) <= 0.0) return;
  vec3 between = mix(a, b, clamp(from / (abs(from - to) > 1e-12 ? from - to : 1e-12), 0.0, 1.0));
  if (to <= 0.0) clipped.last = between;
  if (from <= 0.0) clipped.first = between;
  clipped.sum += dot(edgeTerm(wayTo(from > 0.0 ? a : between), wayTo(to > 0.0 ? b : between)), normal);
}
/// Irradiance of a patch of radiance 1 that a surface with that normal gets on its side of the patch, without what is below its tangent plane.
float patchIrradiance(PatchRow row, vec3 position, vec3 normal) {
  vec3 c = row.center - position;
  float lift = kTangent * length(row.half_u + row.half_v);
  if (dot(c, row.normal) > -lift) return 0.0;
  vec3 r0 = c - row.half_u - row.half_v, r1 = c + row.half_u - row.half_v;
  vec3 r2 = c + row.half_u + row.half_v, r3 = c - row.half_u + row.half_v;
  Clipped clipped = Clipped(0.0, vec3(0.0), vec3(0.0));
  addEdge(clipped, r0, r1, normal, lift);
  addEdge(clipped, r1, r2, normal, lift);
  addEdge(clipped, r2, r3, normal, lift);
  addEdge(clipped, r3, r0, normal, lift);
  clipped.sum += dot(edgeTerm(wayTo(clipped.last), wayTo(clipped.first)), normal);
  return 0.5 * abs(clipped.sum);
}

/// A blocker. `there`: 0 to 1. For a surface that faces as it does one fades out in its plane, and from behind at some distance: a point
/// of a surface may lie a little below the rectangle that stands for it. The ground at a wall's foot faces another way.
const float kPatchNear = 0.03;  // of its size
struct PatchCone {
  vec3 direction;
  float sin_half_angle, there;
};
PatchCone patchCone(PatchRow row, vec3 position, vec3 normal) {
  float scale = length(row.half_u + row.half_v), height = dot(position - row.center, row.normal);
  float own = smoothstep(0.5, 0.9, dot(normal, row.normal));
  // What stands at it is seen from a little before it: rectangles end somewhat short of where wall and ground meet.
  float lift = height > -kPatchNear * scale ? (1.0 - own) * max(0.0, kPatchNear * scale - height) : 0.0, unused;
  vec3 toward = patchVector(row, position + lift * row.normal, unused);
  float size = length(toward);
  float apart = height >= 0.0 ? smoothstep(0.0, 0.002, height / scale) : smoothstep(0.02, 0.1, -height / scale);
  return PatchCone(size > 1e-9 ? toward / size : normal, sqrt(min(size / 3.14159265, 1.0)), mix(1.0, apart, own));
}

#endif
