// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Rectangles of what has no spheres (ground, walls). What one sends to a point is exact (Lambert): the vector irradiance of a polygon of
// radiance 1 is half the sum over edges of the angle that they subtend times the unit normal of the plane through edge and point. As
// a blocker it is the cone of the same vector irradiance, pi sin^2. Includers declare the buffers blocking_patches, sending_patches,
// patch_radiance and push.params.
#ifndef GLOAM_SPHERICAL_LIGHTS_PATCHES_GLSL
#define GLOAM_SPHERICAL_LIGHTS_PATCHES_GLSL
#include "techniques/spherical_lights/spherical_lights_blockers.glsl"

vec3 wayTo(vec3 d) { return d * inversesqrt(max(dot(d, d), 1e-24)); }
vec3 edgeTerm(vec3 a, vec3 b) {
  vec3 across = cross(a, b);
  float size = length(across);
  return size > 1e-6 ? atan(size, dot(a, b)) / size * across : vec3(0.0);
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

/// Logs of what patches leave visible. In its plane one fades out, from behind at some distance: a point of a
/// surface may lie a little below the rectangle that stands for it.
/// `whole`: of all that the cones cover, not only above the tangent plane.
Sh4 logOfPatches(vec3 position, vec3 normal, out Sh4 whole) {
  Sh4 sum = kNothing;
  whole = kNothing;
  for (uint j = 0u; j < push.params.blocking_patches; ++j) {
    float height;
    vec3 toward = patchVector(blocking_patches.at[j], position, height);
    float size = length(toward), a = sqrt(min(size / 3.14159265, 1.0));
    float scale = length(blocking_patches.at[j].half_u + blocking_patches.at[j].half_v);
    float there = height >= 0.0 ? smoothstep(0.0, 0.002, height / scale) : smoothstep(0.02, 0.1, -height / scale);
    vec3 way = size > 1e-9 ? toward / size : normal;
    SeenSphere seen = seenSphere(vec3(0.0), normal, way, a);
    sum = plus(sum, scaled(basisAt(seen.direction), logWeights(seen.sin_half_angle) * there));
    whole = plus(whole, scaled(basisAt(way), logWeights(a) * there));
  }
  return sum;
}

/// Irradiance from patches, each through what spheres leave of its cone; w: that of patches of radiance 1.
vec4 lightOfPatches(vec3 position, vec3 normal, Sh4 visible) {
  vec4 sum = vec4(0.0);
  for (uint j = 0u; j < push.params.sending_patches; ++j) {
    float height;
    vec3 toward = patchVector(sending_patches.at[j], position, height);
    float size = length(toward);
    vec4 disc = discWeights(sqrt(min(size / 3.14159265, 1.0)));
    vec3 way = size > 1e-9 ? toward / size : normal;
    float open = clamp(dotOf(scaled(basisAt(way), disc), visible) / max(disc.x, 1e-12), 0.0, 1.0);
    float facing = height > 0.0 ? max(0.0, dot(toward, normal)) : 0.0;
        sum += vec4(patch_radiance.at[j], 1.0) * (facing * open);
  }
  return sum;
}

/// Patches behind patches count once: together they send from as much as they take of what spheres leave (PX-6's way).
/// clear, behind: irradiance of radiance 1 through what spheres, and what spheres and patches leave.
vec3 withoutOverlap(vec4 light_of_patches, float clear, float behind) {
  float taken = kPatchSlack * max(0.0, clear - behind);
  return light_of_patches.rgb * (light_of_patches.w > 1e-9 ? min(1.0, taken / light_of_patches.w) : 0.0);
}


#endif
