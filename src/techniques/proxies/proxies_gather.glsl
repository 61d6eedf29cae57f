// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-1, PX-3 to PX-5: what one proxy adds at a receiver. Includers declare the constants exponential and indirect_kind, the
// buffers log_table, alone_table, operator_table and the uniform block light, and push push.params. Splats compute one
// half: with GLOAM_PROXIES_ONLY_SHADOW or GLOAM_PROXIES_ONLY_INDIRECT defined, what the other needs is not declared. All is
// written out: the software driver keeps indexed arrays in memory.
#ifndef GLOAM_PROXIES_GATHER_GLSL
#define GLOAM_PROXIES_GATHER_GLSL
#include "math/sh.glsl"
#include "math/sh_log_blocker.glsl"
#include "spheres/receiver_rule.glsl"
#ifndef GLOAM_PROXIES_ONLY_SHADOW
#include "techniques/proxies/proxies_indirect.glsl"
#endif

struct Gathered {
  vec4 log0, log1, log2, log3;  // sum of log visibility, order 4
  vec4 sent;                    // irradiance before normalisation; A: solid angles, each alone
};

/// 0 up to `from`, 1 from `to` on.
float fade(float from, float to, float x) {
  float t = clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Whether a receiver lies in a proxy's sphere of influence; without it the proxy adds nothing.
bool reaches(vec3 position, ProxyRow proxy) {
  vec3 d = proxy.center - position;
  float least = push.params.least_sine;
  return least * least * dot(d, d) < proxy.radius * proxy.radius;
}

/// leaving: light.row.leaving, read once by each receiver.
void addProxy(inout Gathered sum, vec3 position, vec3 normal, ProxyRow proxy, vec3 leaving[9]) {
  SeenSphere seen = seenSphere(position, normal, proxy.center, proxy.radius, proxy.bulge);
  float a = seen.sin_half_angle;
  float coordinate = shLogBlockerCoordinate(a);
  float at = coordinate * float(kLogEntries - 1);
  int below = min(int(at), kLogEntries - 2);
  float faded = fade(push.params.shadow_from, push.params.shadow_to, coordinate);
  float y[16];
  shEvaluate4(seen.direction, y);
#ifndef GLOAM_PROXIES_ONLY_INDIRECT
  vec4 zonal = mix(log_table.at[below], log_table.at[below + 1], at - float(below)) * faded;
  sum.log0 += vec4(y[0], y[1], y[2], y[3]) * zonal.xyyy;
  sum.log1 += vec4(y[4], y[5], y[6], y[7]) * zonal.z;
  sum.log2 += vec4(y[8], y[9], y[10], y[11]) * zonal.zwww;
  sum.log3 += vec4(y[12], y[13], y[14], y[15]) * zonal.w;
#endif
#ifndef GLOAM_PROXIES_ONLY_SHADOW
  if (indirect_kind == kIndirectOff) return;
  float cosine = sqrt(max(0.0, 1.0 - a * a));
  float along = dot(seen.direction, normal);
  float solid_angle = capSolidAngle(a, cosine);
  vec3 arriving;
  if (indirect_kind == kIndirectExact) {
    arriving = exactOnPlane(coordinate, solid_angle, seen.direction, normal, along);
  } else {
    vec3 b0 = leaving[0] * y[0];
    vec3 b1 = leaving[1] * y[1] + leaving[2] * y[2] + leaving[3] * y[3];
    vec3 b2 = leaving[4] * y[4] + leaving[5] * y[5] + leaving[6] * y[6] +
              leaving[7] * y[7] + leaving[8] * y[8];
    bool point = indirect_kind == kIndirectPoint;
    arriving = discRadiance(b0, b1, b2, point ? -1.0 : averaged1(a), point ? 1.0 : averaged2(a)) *
               discOnPlane(a, cosine, along);
  }
  arriving *= fade(push.params.indirect_from, push.params.indirect_to, coordinate);
  int alone = exponential * kLogEntries + below;
  float blocked = mix(alone_table.at[alone], alone_table.at[alone + 1], at - float(below)) * faded;  // as O_p has it
  sum.sent += vec4(arriving * proxy.albedo, blocked);
#endif
}

#endif
