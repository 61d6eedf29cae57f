// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What one sphere blocks at a receiver, and functions of four bands as four vec4 (the software driver keeps indexed arrays in
// memory). Includers declare the buffers spheres and log_table.
#ifndef GLOAM_SPHERICAL_LIGHTS_BLOCKERS_GLSL
#define GLOAM_SPHERICAL_LIGHTS_BLOCKERS_GLSL
#include "math/sh.glsl"
#include "math/sh_exp.glsl"
#include "math/sh_log_blocker.glsl"
#include "spheres/receiver_rule.glsl"

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

/// Place in a table of kLogEntries: below, fraction.
struct TablePlace {
  int below;
  float f;
};
TablePlace tablePlace(float sin_half_angle) {
  float at = shLogBlockerCoordinate(sin_half_angle) * float(kLogEntries - 1);
  int below = min(int(at), kLogEntries - 2);
  return TablePlace(below, at - float(below));
}
vec4 logAt(TablePlace at) { return mix(log_table.at[at.below], log_table.at[at.below + 1], at.f); }

/// G of sphere j at a receiver.
Sh4 logOf(vec3 position, vec3 normal, uint j) {
  SeenSphere seen = seenSphere(position, normal, spheres.at[j].center, spheres.at[j].radius);
  return scaled(basisAt(seen.direction), logAt(tablePlace(seen.sin_half_angle)) * spheres.at[j].blocks);
}

/// V . f of a disc that size: factors of bands.
vec4 discWeights(float a) {
  float a2 = a * a, c2 = max(0.0, 1.0 - a2), c = sqrt(c2);
  return 3.14159265 * a2 * vec4(2.0 / (1.0 + c), 1.0, c, 0.25 * (5.0 * c2 - 1.0));
}

#endif
