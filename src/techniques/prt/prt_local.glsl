// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How much each of an object's probes counts at a place: inverse squared distance, squared (Shepard 1968), softened so that
// the weight has no peak at a probe, times how far the probe is to be trusted. The includer defines `points` (how many),
// probe_places and trust.
#ifndef GLOAM_PRT_LOCAL_GLSL
#define GLOAM_PRT_LOCAL_GLSL
#include "techniques/prt/prt_local_shared.h"

void localWeights(LocalRow row, vec3 place, out float weights[kMostLocalPoints]) {
  float sum = 0.0, trusted = 0.0;
  for (int k = 0; k < points; ++k) {
    vec3 between = probe_places.at[row.first_probe + uint(k)] - place;
    float near = row.softness / (dot(between, between) + row.softness);
    weights[k] = near * near;
    sum += weights[k];
    trusted += weights[k] * trust.at[row.first_probe + uint(k)];
  }
  // Where none can be trusted all count alike; in between, a little of that keeps the blend continuous.
  float all = 0.01 * sum * (1.0 - min(trusted / sum, 1.0)) + 1e-30;
  float scale = 1.0 / (trusted + all);
  for (int k = 0; k < points; ++k)
    weights[k] *= scale * (trust.at[row.first_probe + uint(k)] + all / sum);
}

#endif
