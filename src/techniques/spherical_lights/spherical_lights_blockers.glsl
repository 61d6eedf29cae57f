// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What one sphere blocks at a receiver, and functions of four bands as four vec4 (the software driver keeps indexed arrays in
// memory). Includers declare the uniform block light.
#ifndef GLOAM_SPHERICAL_LIGHTS_BLOCKERS_GLSL
#define GLOAM_SPHERICAL_LIGHTS_BLOCKERS_GLSL
#include "math/sh.glsl"
#include "math/sh_exp.glsl"
#include "math/sh_log_blocker.glsl"
#include "spheres/receiver_rule.glsl"
#include "techniques/spherical_lights/spherical_lights_fits.h"

const vec4 kLogFit[2 * kFitTerms] = vec4[2 * kFitTerms](GLOAM_LOG_FIT);

/// Coefficients 0 to 3, 4 to 7, 8 to 11, 12 to 15.
struct Sh4 {
  vec4 a, b, c, d;
};
const Sh4 kNothing = Sh4(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));

Sh4 plus(Sh4 f, Sh4 g) { return Sh4(f.a + g.a, f.b + g.b, f.c + g.c, f.d + g.d); }
/// Each band times its factor.
Sh4 scaled(Sh4 f, vec4 bands) {
  return Sh4(f.a * bands.xyyy, f.b * bands.z, f.c * bands.zwww, f.d * bands.w);
}
Sh4 scaled(Sh4 f, float by) { return Sh4(f.a * by, f.b * by, f.c * by, f.d * by); }
float dotOf(Sh4 f, Sh4 g) { return dot(f.a, g.a) + dot(f.b, g.b) + dot(f.c, g.c) + dot(f.d, g.d); }
#define GLOAM_ARRAY_OF(f)                                                                                         \
  float[16](f.a.x, f.a.y, f.a.z, f.a.w, f.b.x, f.b.y, f.b.z, f.b.w, f.c.x, f.c.y, f.c.z, f.c.w, f.d.x, f.d.y, f.d.z, f.d.w)
#define GLOAM_SH4_OF(f)                                                                                           \
  Sh4(vec4(f[0], f[1], f[2], f[3]), vec4(f[4], f[5], f[6], f[7]), vec4(f[8], f[9], f[10], f[11]),                 \
      vec4(f[12], f[13], f[14], f[15]))

Sh4 basisAt(vec3 direction) {
  float y[16];
  shEvaluate4(direction, y);
  return GLOAM_SH4_OF(y);
}

#define GLOAM_FIT(c, x) \
  (((((((((c(9) * x + c(8)) * x + c(7)) * x + c(6)) * x + c(5)) * x + c(4)) * x + c(3)) * x + c(2)) * x + c(1)) * x + c(0))
/// Logs of what a sphere leaves visible, by band.
vec4 logWeights(float sin_half_angle) {
  float t = shLogBlockerCoordinate(sin_half_angle);
  float x = 2.0 * t / kLogSplit - 1.0, above = 2.0 * (t - kLogSplit) / (1.0 - kLogSplit) - 1.0;
#define GLOAM_LOG(i) kLogFit[i]
#define GLOAM_LOG_ABOVE(i) kLogFit[kFitTerms + i]
  vec4 low = GLOAM_FIT(GLOAM_LOG, x), high = GLOAM_FIT(GLOAM_LOG_ABOVE, above);
  return sin_half_angle * sin_half_angle * (t > kLogSplit ? high : low);
}
vec4 averageWeights(float sin_half_angle) {
  float x = 2.0 * shLogBlockerCoordinate(sin_half_angle) - 1.0;
#define GLOAM_AVERAGE(i) light.row.average_fit[i]
  return GLOAM_FIT(GLOAM_AVERAGE, x);
}

/// The head of a SphereRow.
struct Ball {
  vec3 center;
  float radius, blocks, bulge;
  uint first_listed, listed;
};
Ball ballOf(SphereRow row) { return Ball(row.center, row.radius, row.blocks, row.bulge, row.first_listed, row.listed); }
/// G of a sphere at a receiver.
Sh4 logOf(vec3 position, vec3 normal, Ball ball) {
  SeenSphere seen = seenSphere(position, normal, ball.center, ball.radius, ball.bulge);
  return scaled(basisAt(seen.direction), logWeights(seen.sin_half_angle) * ball.blocks);
}

/// V . f of a disc that size: factors of bands.
vec4 discWeights(float a) {
  float a2 = a * a, c2 = max(0.0, 1.0 - a2), c = sqrt(c2);
  return 3.14159265 * a2 * vec4(2.0 / (1.0 + c), 1.0, c, 0.25 * (5.0 * c2 - 1.0));
}

/// Irradiance of a disc of radiance 1 that lies above the tangent plane, as seenSphere leaves it.
float irradianceOfDisc(SeenSphere seen, vec3 normal) {
  return 3.14159265 * seen.sin_half_angle * seen.sin_half_angle * max(0.0, dot(seen.direction, normal));
}

/// Legendre's P_0 to P_3, times (2 l + 1) / 4 pi: what a zonal function has at that cosine from its axis.
vec4 zonalAt(float x) {
  return vec4(0.0795774715, 0.238732415 * x, 0.397887358 * (1.5 * x * x - 0.5), 0.557042301 * x * (2.5 * x * x - 1.5));
}

#endif
