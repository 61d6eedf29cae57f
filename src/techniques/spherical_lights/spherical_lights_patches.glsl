// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What rectangles of ground and walls (frame/patch.glsl) block and send. Includers declare push.params and what
// reads rows: spherical_lights_rows.glsl, or …_lanes.glsl.
#ifndef GLOAM_SPHERICAL_LIGHTS_PATCHES_GLSL
#define GLOAM_SPHERICAL_LIGHTS_PATCHES_GLSL
#include "frame/patch.glsl"
#include "techniques/spherical_lights/spherical_lights_blockers.glsl"

/// 0 where a patch lies below the tangent plane: the rim of a plinth does not stand before its top.
float aboveTangent(PatchRow row, vec3 position, vec3 normal) {
  float extent = abs(dot(row.half_u, normal)) + abs(dot(row.half_v, normal));
  float top = dot(row.center - position, normal) + extent;
  return smoothstep(0.0, 0.1, top / (extent + 1e-3 * length(row.half_u + row.half_v)));
}

/// Logs of what patches leave visible.
/// `whole`: of all that the cones cover, not only above the tangent plane.
Sh4 logOfPatches(vec3 position, vec3 normal, out Sh4 whole) {
  Sh4 sum = kNothing;
  whole = kNothing;
  for (uint j = 0u; j < push.params.blocking_patches; ++j) {
    PatchRow row = blockingPatch(j);
    PatchCone cone = patchCone(row, position, normal);
    float above = aboveTangent(row, position, normal);
    SeenSphere seen = seenSphere(vec3(0.0), normal, cone.direction, cone.sin_half_angle, 0.0);
    sum = plus(sum, scaled(basisAt(seen.direction), logWeights(seen.sin_half_angle) * (cone.there * above)));
    whole = plus(whole, scaled(basisAt(cone.direction), logWeights(cone.sin_half_angle) * cone.there));
  }
  return sum;
}

/// What four bands of closed walls let through goes: 0 where rectangles that no light from far away meets are all around. That a few of them hide
/// one another counts them twice, where it is dark.
float skyLeft(vec3 position, vec3 normal) {
  float taken = 0.0;
  for (uint j = 0u; j < push.params.enclosed_patches; ++j) {
    taken += patchIrradiance(sendingPatch(j), position, normal);
  }
  return smoothstep(0.0, kSkyLeft, 1.0 - taken / 3.14159265);
}

/// How much of a ball that shines rectangles leave: each as it stands on the way to its middle, its edges as blurred as from a disc that
/// large. None stands before its own surface, or before a ball that it touches.
float ballPastPatches(vec3 position, vec3 normal, vec3 center, float radius) {
  vec3 way = center - position;
  float far = length(way), left = 1.0;
  for (uint j = 0u; j < push.params.blocking_patches; ++j) {
    PatchRow row = blockingPatch(j);
    float height = dot(row.center - position, row.normal), slope = dot(way, row.normal);
    float t = abs(slope) > 1e-9 ? height / slope : -1.0;
    if (t <= 0.0 || t >= 1.0) continue;
    vec3 hit = position + t * way - row.center;
    vec2 size = max(vec2(length(row.half_u), length(row.half_v)), vec2(1e-9));
    vec2 inside = size - abs(vec2(dot(hit, row.half_u), dot(hit, row.half_v))) / size;
    vec2 share = clamp(0.5 + 0.5 * inside / max(t * radius, 1e-4), vec2(0.0), vec2(1.0));
    float own = smoothstep(0.5, 0.9, abs(dot(normal, row.normal)));
    float there = 1.0 - own * (1.0 - smoothstep(0.5, 1.0, abs(height) / (kPatchOwn * min(size.x, size.y))));
    left *= 1.0 - share.x * share.y * there * clamp((1.0 - t) * far / radius - 1.0, 0.0, 1.0);
  }
  return left;
}

/// Irradiance from patches, each through what spheres leave of its cone; w: that of patches of radiance 1.
vec4 lightOfPatches(vec3 position, vec3 normal, Sh4 visible) {
  vec4 sum = vec4(0.0);
  for (uint j = 0u; j < push.params.sending_patches; ++j) {
    float height;
    PatchRow row = sendingPatch(j);
    vec3 toward = patchVector(row, position, height);
    float size = length(toward);
    float sin_half_angle = sqrt(min(size / 3.14159265, 1.0));
    vec4 disc = discWeights(sin_half_angle);
    vec3 way = size > 1e-9 ? toward / size : normal;
    float open = clamp(dotOf(scaled(basisAt(way), disc), visible) / max(disc.x, 1e-12), 0.0, 1.0);
    // Lambert's where it is above the tangent plane; where it crosses that, no less than the disc of the same vector irradiance.
    SeenSphere seen = seenSphere(vec3(0.0), normal, way, sin_half_angle, 0.0);
    float facing = height > 0.0 ? max(dot(toward, normal), irradianceOfDisc(seen, normal)) : 0.0;
    sum += vec4(patchRadiance(j), 1.0) * (facing * open);
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
