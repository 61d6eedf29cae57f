// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-2, PX-6: O_p = exp of the sum of logs, what it lets through, and the share of the proxies' solid angles that is not
// counted twice. Includers declare the uniform block light.
#ifndef GLOAM_PROXIES_SHADE_GLSL
#define GLOAM_PROXIES_SHADE_GLSL
#include "frame/light_peak.glsl"
#include "math/sh.glsl"
#include "math/sh_exp.glsl"

void expOfLog(int method, vec4 log0, vec4 log1, vec4 log2, vec4 log3, out float o[16]) {
  float f[16] = float[16](log0.x, log0.y, log0.z, log0.w, log1.x, log1.y, log1.z, log1.w, log2.x, log2.y, log2.z,
                          log2.w, log3.x, log3.y, log3.z, log3.w);
  if (method == kExpSeries) shExpSeries4(f, kExpTerms, o);
  if (method == kExpLinear) shExpLinear4(f, o);
  if (method == kExpHybrid) shExpHybrid4(f, o);
  if (method == kExpQuadratic) shExpQuadratic4(f, o);
}

/// Both parts, where irradiance of the rest is known with its change by the normal, a colour each, and how much is left of the peak.
vec3 litByPlanes(vec4 red, vec4 green, vec4 blue, float peak_left, vec3 normal) {
  vec4 n = vec4(normal, 1.0);
  float facing = max(0.0, dot(normal, light.row.peak.direction));
  return max(vec3(dot(red, n), dot(green, n), dot(blue, n)), vec3(0.0)) +
         clamp(peak_left, 0.0, 1.0) * facing * light.row.peak.irradiance;
}

/// xi: the solid angle that all proxies block together over the sum of what each would alone.
float overlapShare(float o0, float solid_angles) {
  float blocked = max(0.0, kShZonal0 - o0) * kShZonal0;
  return solid_angles > 0.0 ? min(1.0, blocked / solid_angles) : 0.0;
}

#endif
