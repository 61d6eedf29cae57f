// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Irradiance of a light's peak (frame/light_peak.h) through four bands of visibility O: O where the peak stands, times the cosine.
// Includers declare a uniform block `light` whose `row` holds shade[144] (frame/field_shade.h) of the rest, and the peak.
#ifndef GLOAM_FRAME_LIGHT_PEAK_GLSL
#define GLOAM_FRAME_LIGHT_PEAK_GLSL
#include "frame/field_shade.glsl"
#include "frame/light_peak_shared.h"

/// How much is left of it. Ringing may leave visibility outside 0 to 1, which counts as these.
float peakLeft(LightPeak peak, const float o[16]) {
  float seen = o[0] * peak.basis[0] + o[1] * peak.basis[1] + o[2] * peak.basis[2] + o[3] * peak.basis[3] +
               o[4] * peak.basis[4] + o[5] * peak.basis[5] + o[6] * peak.basis[6] + o[7] * peak.basis[7] +
               o[8] * peak.basis[8] + o[9] * peak.basis[9] + o[10] * peak.basis[10] + o[11] * peak.basis[11] +
               o[12] * peak.basis[12] + o[13] * peak.basis[13] + o[14] * peak.basis[14] + o[15] * peak.basis[15];
  return clamp(seen, 0.0, 1.0);
}
vec3 peakThrough(LightPeak peak, const float o[16], vec3 normal) {
  return peakLeft(peak, o) * max(0.0, dot(normal, peak.direction)) * peak.irradiance;
}

/// Distant light, both parts.
vec3 litThrough(const float o[16], vec3 normal) {
  return irradianceThrough(o, normal) + peakThrough(light.row.peak, o, normal);
}

#endif
