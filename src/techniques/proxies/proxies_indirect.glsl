// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-3 to PX-5: what a proxy sends to a receiver, as irradiance without the proxy's albedo: I_i . H(N). Directions d point
// from receiver to proxy, a is the sine of its half-angle. Includers declare the uniform block light.row and, for the exact
// operator, the buffer operator_table.
#ifndef GLOAM_PROXIES_INDIRECT_GLSL
#define GLOAM_PROXIES_INDIRECT_GLSL

const float kZonalCosine0 = 0.88622693f;  // of the clamped cosine: sqrt(pi) / 2, sqrt(pi / 3), sqrt(5 pi) / 8
const float kZonalCosine1 = 1.02332671f;
const float kZonalCosine2 = 0.49541592f;

/// 2 pi (1 - cos), cos the cosine of the half-angle.
float capSolidAngle(float a, float cosine) { return 6.28318531f * a * a / (1.0f + cosine); }

/// V . H(N): irradiance of a disc of radiance 1, both to three bands. along = d . N.
float discOnPlane(float a, float cosine, float along) {
  float v0 = 1.77245385f * a * a / (1.0f + cosine);
  float v1 = 1.53499006f * a * a;
  float v2 = 1.98166365f * cosine * a * a;
  return v0 * kZonalCosine0 + v1 * kZonalCosine1 * along +
         v2 * kZonalCosine2 * (1.5f * along * along - 0.5f);
}

/// PX-4: the mean over the disc of y_l of the sphere's normal, l = 1, 2, as a rotated zonal function would have it; the
/// paper's polynomials times sqrt(4 pi / (2 l + 1)).
float averaged1(float a) { return 2.04665342f * ((0.08432f * a - 0.25073f) * a - 0.32494f); }
float averaged2(float a) { return 1.58533092f * (((-0.22230f * a + 0.22502f) * a + 0.47398f) * a + 0.15950f); }

/// PX-3 with factors (-1, 1), PX-4 with the averages: radiance of the whole disc.
vec3 discRadiance(vec3 b0, vec3 b1, vec3 b2, float factor1, float factor2) {
  return b0 + factor1 * b1 + factor2 * b2;
}

/// PX-5: the operator is diagonal in m about the axis d; the receiver's normal lies in the plane of d and t.
vec3 exactOnPlane(float place, float solid_angle, vec3 d, vec3 n, float along) {
  float at = clamp(place, 0.0f, 1.0f) * float(kOperatorEntries - 1);
  int below = min(int(at), kOperatorEntries - 2);
  float f = at - float(below);
  vec4 r0 = mix(operator_table.at[4 * below], operator_table.at[4 * below + 4], f);
  vec4 r1 = mix(operator_table.at[4 * below + 1], operator_table.at[4 * below + 5], f);
  vec4 r2 = mix(operator_table.at[4 * below + 2], operator_table.at[4 * below + 6], f);
  vec4 r3 = mix(operator_table.at[4 * below + 3], operator_table.at[4 * below + 7], f);
  vec3 side = n - along * d;
  float sine = length(side);
  vec3 t = sine > 1e-4f ? side / sine : vec3(0.0f);
  const float kA = 1.09254843f, kB = 0.546274215f, kC = 0.630783131f;
  vec3 td = light.row.tensor[0] * d.x + light.row.tensor[3] * d.y + light.row.tensor[5] * d.z;
  vec3 td_y = light.row.tensor[3] * d.x + light.row.tensor[1] * d.y + light.row.tensor[4] * d.z;
  vec3 td_z = light.row.tensor[5] * d.x + light.row.tensor[4] * d.y + light.row.tensor[2] * d.z;
  vec3 tt_x = light.row.tensor[0] * t.x + light.row.tensor[3] * t.y + light.row.tensor[5] * t.z;
  vec3 tt_y = light.row.tensor[3] * t.x + light.row.tensor[1] * t.y + light.row.tensor[4] * t.z;
  vec3 tt_z = light.row.tensor[5] * t.x + light.row.tensor[4] * t.y + light.row.tensor[2] * t.z;
  vec3 dd = td * d.x + td_y * d.y + td_z * d.z;
  vec3 dt = td * t.x + td_y * t.y + td_z * t.z;
  vec3 tt = tt_x * t.x + tt_y * t.y + tt_z * t.z;
  // The light's coefficients about d: l00, l10, l20; l11, l21; l22.
  vec3 l00 = light.row.leaving[0];
  vec3 l10 = light.row.leaving[3] * d.x + light.row.leaving[1] * d.y + light.row.leaving[2] * d.z;
  vec3 l11 = light.row.leaving[3] * t.x + light.row.leaving[1] * t.y + light.row.leaving[2] * t.z;
  vec3 l20 = dd / kC, l21 = dt / kB, l22 = (2.0f * tt + dd) / (2.0f * kB);
  // A_l y_lm(N) about d.
  const float kA0 = 3.14159265f, kA1 = 2.09439510f, kA2 = 0.785398163f;
  float h00 = kA0 * 0.282094792f, h10 = kA1 * 0.488602512f * along, h11 = kA1 * 0.488602512f * sine;
  float h20 = kA2 * 0.315391565f * (3.0f * along * along - 1.0f), h21 = kA2 * kA * sine * along;
  float h22 = kA2 * kB * sine * sine;
  vec3 sum = h00 * (r0.x * l00 + r0.y * l10 + r0.z * l20);
  sum += h10 * (r0.w * l00 + r1.x * l10 + r1.y * l20);
  sum += h20 * (r1.z * l00 + r1.w * l10 + r2.x * l20);
  sum += h11 * (r2.y * l11 + r2.z * l21) + h21 * (r2.w * l11 + r3.x * l21);
  sum += h22 * r3.y * l22;
  return solid_angle * sum;
}

#endif
