// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Lamps through transfer, each in the direction in which the vertex itself sees it; what of the scene stands before it is
// known at the probes. A lamp is a point, of which the bands of transfer show a disc of 40 degrees: its light would leak round
// the terminator and past its own brightest spot. So transfer says what share of a plane's light through the same bands
// arrives, DS . y(s) / (DU . y(s)), and the cosine is exact.
#ifndef GLOAM_PRT_LOCAL_LAMPS_GLSL
#define GLOAM_PRT_LOCAL_LAMPS_GLSL

float windowOfBand(uint i) { return 0.5 + 0.5 * cos(kPi * floor(sqrt(float(i) + 0.5)) / float(order)); }

/// DU . y(s) at a cosine: sum of A_l (2 l + 1) / 4 pi P_l, the window's factors among them.
float truncatedCosine(float c) {
  float c2 = c * c, sum = 0.25 * push.params.band[0];
  if (order > 1) sum += 0.5 * push.params.band[1] * c;
  if (order > 2) sum += 0.15625 * push.params.band[2] * (3.0 * c2 - 1.0);
  if (order > 4) sum -= 0.01171875 * push.params.band[4] * ((35.0 * c2 - 30.0) * c2 + 3.0);
  return sum;
}

#define LOAD_DIRECT(a) m[a] = uint(a) < kCoefficients ? push.params.band[uint(sqrt(float(a) + 0.5))] * direct(block, uint(a), lane) : 0.0;
#define LOAD_DIRECT_PAIR(a, b) LOAD_DIRECT(a) LOAD_DIRECT(b)
#define ADD_LAMP(a) if (uint(a) < kCoefficients) { arrived += m[a] * y[a]; all[a] += irradiance * y[a]; }
#define ADD_LAMP_PAIR(a, b) ADD_LAMP(a) ADD_LAMP(b)
#define ADD_BOUNCED(a)                                                                                   \
  if (uint(a) < kCoefficients) {                                                                         \
    vec3 part = push.params.band[uint(sqrt(float(a) + 0.5))] * indirect(block, uint(a), lane) * all[a]; \
    bounced += part;                                                                                     \
    if (damped) soft_bounced += windowOfBand(uint(a)) * part;                                            \
  }
#define ADD_BOUNCED_PAIR(a, b) ADD_BOUNCED(a) ADD_BOUNCED(b)

/// Direct light of all lamps, where they shine through transfer; what of them bounces on the object is added to `bounced`.
/// `normal` in the object's axes; 0: it is not known.
vec3 lampLight(LocalRow row, uint block, uint lane, vec3 place, vec3 normal, float weights[kMostLocalPoints], inout vec3 bounced,
               inout vec3 soft_bounced) {
  float m[36], y[36];
  vec3 all[36], sum = vec3(0.0);
  PAIRS(kCoefficients, LOAD_DIRECT_PAIR)
  for (int a = 0; a < 36; ++a) all[a] = vec3(0.0);
  for (uint k = 0u; k < push.params.lamp_count; ++k) {
    float seen = 0.0;
    for (int p = 0; p < points; ++p) seen += weights[p] * lamps_seen.at[(row.first_probe + uint(p)) * push.params.lamp_count + k];
    vec3 to_lamp;
    vec3 irradiance = seen * lampIrradiance(lamps.at[k], place, to_lamp);
    to_lamp = row.object_from_world * to_lamp;
    shEvaluate6(to_lamp, y);
    float arrived = 0.0;
    PAIRS(kCoefficients, ADD_LAMP_PAIR)
    float cosine = dot(normal, to_lamp);
    if (normal != vec3(0.0)) arrived = max(cosine, 0.0) * clamp(arrived / max(truncatedCosine(cosine), 0.01), 0.0, 1.0);
    sum += max(arrived, 0.0) * irradiance;
  }
  if (has_indirect) { PAIRS(kCoefficients, ADD_BOUNCED_PAIR) }
  return push.params.lamps_direct != 0u ? sum : vec3(0.0);
}

#endif
