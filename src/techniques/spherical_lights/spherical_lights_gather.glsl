// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// All light at one receiver, any way (spherical_lights_receive.glsl is the quick one). Includers declare the constants blocking,
// visibility_kind, has_indirect, glows, the buffers spheres, objects, sent, glow, meets, the uniform block light, and push push.params.
#ifndef GLOAM_SPHERICAL_LIGHTS_GATHER_GLSL
#define GLOAM_SPHERICAL_LIGHTS_GATHER_GLSL
#include "techniques/spherical_lights/spherical_lights_blockers.glsl"
#include "techniques/spherical_lights/spherical_lights_rows.glsl"
#include "techniques/spherical_lights/spherical_lights_patches.glsl"
#include "techniques/spherical_lights/spherical_lights_radiance.glsl"
#include "frame/light_peak.glsl"

/// The group (object, or sphere) that follows in order of its centre's distance, equal ones by number.
uint nextGroup(vec3 position, inout float key, uint last) {
  uint best = 0xffffffffu, count = blocking == kPerObject ? push.params.objects : push.params.spheres;
  float least = 3e38;
  for (uint g = 0u; g < count; ++g) {
    vec3 d = (blocking == kPerObject ? objects.at[g].center : spheres.at[g].center) - position;
    float far = dot(d, d);
    bool after = far > key || (far == key && g > last && last != 0xffffffffu);
    if (after && far < least) {
      least = far;
      best = g;
    }
  }
  key = least;
  return best;
}

bool meeting(uint i, uint j) {
  uint bit = j - spheres.at[i].first;
  return bit < spheres.at[i].count && (meets.at[i * push.params.words + bit / 32u] >> (bit % 32u) & 1u) != 0u;
}

/// Logs of what stands before sphere i, next to those of all groups before its own.
Sh4 blockersWithin(vec3 position, vec3 normal, uint i, inout bool any_there) {
  Sh4 sum = kNothing;
  bool all = blocking == kPerSphere;
  uint first = all ? 0u : spheres.at[i].first, end = all ? push.params.spheres : first + spheres.at[i].count;
  vec3 to_i = spheres.at[i].center - position;
  float own = dot(to_i, to_i);
  for (uint j = first; j < end; ++j) {
    vec3 to_j = spheres.at[j].center - position;
    float far = dot(to_j, to_j);
    bool nearer = far < own || (far == own && j < i);
    if (j != i && nearer && meeting(i, j) == (blocking == kPerSphereReused)) {
      any_there = true;
      sum = plus(sum, logOf(position, normal, j));
    }
  }
  return sum;
}

Gathered gather(vec3 position, vec3 normal) {
  Gathered got = Gathered(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
  // The clamped cosine about the normal; its fourth band is 0.
  Sh4 cosine = scaled(basisAt(normal), vec4(kShCosine0, kShCosine1, kShCosine2, 0.0));
  Sh4 before = kNothing, own = kNothing, seen_through = kNothing;
  const bool send = has_indirect || glows;
  vec3 glowing = vec3(0.0);
  vec4 from_patches = vec4(0.0);
  float clear_of_spheres = 0.0;
  bool kept = false;  // seen_through is that of `before`
  float key = -1.0, clear = 0.0;
  uint last = 0xffffffffu, i = 0u, left = 0u;
  uint steps = push.params.spheres + 2u;
  Sh4 whole, patch_logs = logOfPatches(position, normal, whole);
  float sky_left = skyLeft(position, normal);
  // After all spheres: what they leave, through which patches are seen; how much of that patches take; then both before the environment.
  for (uint k = 0u; k <= steps; ++k) {
    bool final = k == steps, spheres_done = k + 2u >= steps, patches_taken = k + 1u == steps;
    if (left == 0u) {
      before = plus(before, own);
      own = kNothing;
      kept = false;
      if (!spheres_done) {
        last = nextGroup(position, key, last);
        i = blocking == kPerObject ? objects.at[last].first : last;
        left = blocking == kPerObject ? objects.at[last].count : 1u;
      }
    }
    Sh4 blockers = before, y = kNothing, log_i = kNothing;
    SeenSphere seen = SeenSphere(0.0, normal);
    bool more = false;
    if (patches_taken) blockers = plus(before, whole);
    if (final) blockers = plus(before, patch_logs);
    if (!spheres_done) {
      seen = seenSphere(position, normal, spheres.at[i].center, spheres.at[i].radius, spheres.at[i].bulge);
      y = basisAt(seen.direction);
      log_i = scaled(y, logWeights(seen.sin_half_angle));
      log_i = scaled(log_i, spheres.at[i].blocks);
      own = plus(own, log_i);
      if (send && seen.sin_half_angle > 0.0) {
        Sh4 within = blockersWithin(position, normal, i, more);
        blockers = blocking == kPerSphere         ? within
                   : blocking == kPerSphereReused ? plus(before, scaled(within, -1.0))
                                                  : plus(before, within);
        more = more || blocking == kPerSphere;
      }
    }
    bool looked_at = send && seen.sin_half_angle > 0.0;
    bool wanted = spheres_done || (visibility_kind != kMean && looked_at && (more || !kept));
    float behind = 0.0;
    for (int t = 0; t < (visibility_kind == kDifference ? 2 : 1); ++t) {
      if (t == 0 ? !wanted : !looked_at) continue;
      Sh4 f = blockers;
      if (t == 1) f = plus(blockers, log_i);
      float e[16];
      shExpQuadratic4(GLOAM_ARRAY_OF(f), e);
      if (final) {
        got.direct = litThrough(e, normal) * sky_left;
        got.visibility = e[0] / kShZonal0 * sky_left;
      } else if (patches_taken) {
        got.indirect += withoutOverlap(from_patches, clear_of_spheres, dotOf(GLOAM_SH4_OF(e), cosine) * sky_left);
      } else if (spheres_done && has_indirect) {
        from_patches = lightOfPatches(position, normal, GLOAM_SH4_OF(e));
        clear_of_spheres = dotOf(GLOAM_SH4_OF(e), cosine);
      } else if (visibility_kind == kDifference) {
        float through = dotOf(GLOAM_SH4_OF(e), cosine);
        if (t == 0) clear = through; else behind = through;
      } else {
        float product[16];
        shProduct4(e, GLOAM_ARRAY_OF(cosine), product);
        seen_through = GLOAM_SH4_OF(product);
      }
      if (t == 0) kept = !more;
    }
    if (looked_at) {
      vec4 disc = discWeights(seen.sin_half_angle);
      float share = visibility_kind == kDifference ? clear - behind : dotOf(scaled(y, disc), seen_through);
      if (visibility_kind == kMean) {
        float mean_log = dotOf(scaled(y, disc), blockers) / max(disc.x, 1e-12);
        share = exp(min(mean_log, 0.0)) * irradianceOfDisc(seen, normal);
      }
      share = max(share, 0.0);
      Sh4 f = averageAt(seen.sin_half_angle, y);
      if (has_indirect) {
        vec3 radiance = GLOAM_RADIANCE(sent.at[i]);
        got.indirect += radiance * share;
        got.unblocked += radiance * irradianceOfDisc(seen, normal);
      }
      if (glows) {
        vec3 radiance = GLOAM_RADIANCE(glow.at[i]) * share;
        if (radiance != vec3(0.0))
          glowing += radiance * ballPastPatches(position, normal, spheres.at[i].center, spheres.at[i].radius);
      }
    }
    if (final) got.direct += glowing;
    ++i;
    if (left > 0u) --left;
  }
  return got;
}

#endif
