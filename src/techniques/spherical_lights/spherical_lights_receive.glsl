// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// All light at one receiver, visibility of a sphere as exp of the mean log over its disc: no exponential of a function but the last,
// and long loops run over the same rows for all receivers, which is what software drivers are quick at. Groups (objects, or single
// spheres) are put in order by rank; sums of logs are kept along it, so each sphere finds what stands before its group as one sum,
// however many there are (SL-14). Of its own object a sphere adds what it does not meet (per object) or takes back what it meets (per
// sphere): its list. Includers declare the constants blocking, most_groups, has_indirect, glows, hierarchy and by_lanes, the buffers spheres, objects,
// sent, glow, listed, cuts, ratios and those of patches, the uniform block light, and push push.params.
#ifndef GLOAM_SPHERICAL_LIGHTS_RECEIVE_GLSL
#define GLOAM_SPHERICAL_LIGHTS_RECEIVE_GLSL
#include "techniques/spherical_lights/spherical_lights_blockers.glsl"
#include "techniques/spherical_lights/spherical_lights_lanes.glsl"
#include "techniques/spherical_lights/spherical_lights_patches.glsl"
#include "techniques/spherical_lights/spherical_lights_radiance.glsl"
#include "techniques/spherical_lights/spherical_lights_within.glsl"
#include "frame/light_peak.glsl"

/// Which spheres stand for an object, and by how much what they send (and, w, block) is scaled: SL-8, where `hierarchy`.
LevelRow spheresOf(uint cluster, uint o) {
  if (hierarchy) return cuts.at[cluster * push.params.objects + o];
  return LevelRow(objects.at[o].first, objects.at[o].count);
}
vec4 ratioOf(uint cluster, uint i) {
  if (!hierarchy || i < push.params.spheres) return vec4(1.0);
  return ratios.at[cluster * push.params.coarse + i - push.params.spheres];
}

Gathered receive(vec3 position, vec3 normal) {
  uint cluster = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  Gathered got = Gathered(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
  float kept[16u * most_groups], far[most_groups];
  uint order[most_groups];
  const bool send = has_indirect || glows;
  Sh4 all = kNothing;
  for (uint o = 0u; o < push.params.objects; ++o) {
    Sh4 own = kNothing;
    LevelRow cut = spheresOf(cluster, o);
    for (uint i = cut.first; i < cut.first + cut.count; ++i) {
      Ball ball = ballAt(i);
      ball.blocks *= ratioOf(cluster, i).w;
      own = plus(own, logOf(position, normal, ball));
    }
    all = plus(all, own);
    if (send) {
      float f[16] = GLOAM_ARRAY_OF(own);
      for (uint c = 0u; c < 16u; ++c) kept[16u * o + c] = f[c];
      vec3 d = objects.at[o].center - position;
      far[o] = dot(d, d);
    }
  }
  const uint groups = send ? push.params.objects : 0u;
  // Ranks of eight at once: an array that a variable indexes costs more to read than to compare.
  for (uint o = 0u; o < groups; o += 8u) {
    uvec4 low = o + uvec4(0u, 1u, 2u, 3u), high = low + 4u, ranks = uvec4(0u), more = uvec4(0u);
    vec4 a = vec4(far[o], far[o + 1u], far[o + 2u], far[o + 3u]);
    vec4 b = vec4(far[o + 4u], far[o + 5u], far[o + 6u], far[o + 7u]);
    for (uint q = 0u; q < groups; ++q) {
      vec4 f = vec4(far[q]);
      ranks += mix(uvec4(lessThan(f, a)), uvec4(lessThanEqual(f, a)), lessThan(uvec4(q), low));
      more += mix(uvec4(lessThan(f, b)), uvec4(lessThanEqual(f, b)), lessThan(uvec4(q), high));
    }
    for (uint k = 0u; k < 8u; ++k) {
      uint rank = k < 4u ? ranks[k] : more[k - 4u];
      if (o + k < groups) order[rank] = o + k;
    }
  }
  // In place of each group's logs the sum of those before it.
  float running[16] = GLOAM_ARRAY_OF(kNothing);
  for (uint k = 0u; k < groups; ++k) {
    uint at = 16u * order[k];
    for (uint c = 0u; c < 16u; ++c) {
      float own = kept[at + c];
      kept[at + c] = running[c];
      running[c] += own;
    }
  }
  for (uint o = 0u; o < groups; ++o) {
    float f[16];
    for (uint c = 0u; c < 16u; ++c) f[c] = kept[16u * o + c];
    Sh4 before = GLOAM_SH4_OF(f);
    LevelRow cut = spheresOf(cluster, o);
    for (uint i = cut.first; i < cut.first + cut.count; ++i) {
      Ball ball = ballAt(i);
      SeenSphere seen = seenSphere(position, normal, ball.center, ball.radius, ball.bulge);
      vec4 disc = discWeights(seen.sin_half_angle), bands = disc / max(disc.x, 1e-12);
      Sh4 y = basisAt(seen.direction);
      float within = logListed(position, normal, i, ball, seen.direction, bands);
      float log_before = dotOf(scaled(y, bands), before) + (blocking == kPerObject ? within : -within);
      float open = irradianceOfDisc(seen, normal);
      float share = open * exp(min(log_before, 0.0));
      Sh4 f = averageAt(seen.sin_half_angle, y);
      if (has_indirect) {
        vec3 radiance = radianceOf(i, f) * ratioOf(cluster, i).rgb;
        got.indirect += radiance * share;
        got.unblocked += radiance * open;
      }
      if (glows) {
        vec3 radiance = glowOf(i, f) * share;
        for (uint k = subgroupAny(radiance != vec3(0.0)) ? 0u : 1u; k < 1u; ++k)
          got.direct += radiance * ballPastPatches(position, normal, ball.center, ball.radius);
      }
    }
  }
  // What spheres leave, through which patches are seen; how much of that patches take; then both before the environment.
  Sh4 cosine = scaled(basisAt(normal), vec4(kShCosine0, kShCosine1, kShCosine2, 0.0));
  Sh4 whole, patch_logs = logOfPatches(position, normal, whole);
  vec4 from_patches = vec4(0.0);
  float clear = 0.0, sky_left = skyLeft(position, normal);
  for (int t = has_indirect && push.params.sending_patches > 0u ? 0 : 2; t < 3; ++t) {
    Sh4 f = all;
    if (t == 1) f = plus(all, whole);
    if (t == 2) f = plus(all, patch_logs);
    float e[16];
    shExpQuadratic4(GLOAM_ARRAY_OF(f), e);
    float through = dotOf(GLOAM_SH4_OF(e), cosine);
    if (t == 0) {
      from_patches = lightOfPatches(position, normal, GLOAM_SH4_OF(e));
      clear = through;
    } else if (t == 1) {
      got.indirect += withoutOverlap(from_patches, clear, through * sky_left);
    } else {
      got.direct += litThrough(e, normal) * sky_left;
      got.visibility = e[0] / kShZonal0 * sky_left;
    }
  }
  return got;
}

#endif
