// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The one material, in shaders: the functions of math/brdf.h under the same names (RF-5; Segovia, Wald 2008).
#ifndef GLOAM_MATH_BRDF_GLSL
#define GLOAM_MATH_BRDF_GLSL

#include "math/sh.glsl"

const float kMaxPhongExponent = 1.0e6f;
const float kInvPi = 0.318309886183791f;

struct Lobes {
  vec3 diffuse;    // k_d
  vec3 specular;   // k_s
  float exponent;  // n
};

float phongExponent(float roughness) {
  float alpha2 = roughness * roughness * roughness * roughness;
  return clamp(2.0f / max(alpha2, 1e-12f) - 2.0f, 1.0f, kMaxPhongExponent);
}

Lobes makeLobes(vec3 base_color, float metallic, float roughness, float specular) {
  Lobes lobes;
  lobes.diffuse = base_color * (1.0f - metallic);
  lobes.specular = mix(vec3(0.04f * specular), base_color, metallic);
  lobes.exponent = phongExponent(roughness);
  return lobes;
}

vec3 mirrorDirection(vec3 normal, vec3 to_view) { return 2.0f * dot(normal, to_view) * normal - to_view; }

/// The lobes without k_d and k_s, in 1/sr. Directions below the geometric horizon are the caller's to drop.
float lambertLobe(vec3 normal, vec3 direction) { return max(0.0f, dot(normal, direction)) * kInvPi; }

float phongLobe(float exponent, vec3 mirror, vec3 direction) {
  float cosine = dot(mirror, direction);
  if (cosine <= 0.0f) {
    return 0.0f;
  }
  return (exponent + 1.0f) * 0.5f * kInvPi * pow(cosine, exponent);
}

vec3 evaluateLobes(Lobes lobes, vec3 normal, vec3 to_view, vec3 direction) {
  return lobes.diffuse * lambertLobe(normal, direction) +
         lobes.specular * phongLobe(lobes.exponent, mirrorDirection(normal, to_view), direction);
}

/// Convolution factors of bands 0 to 5: A_l / pi, and Phong's, where band l follows from l - 2 by (n - l + 2) / (n + l + 1).
const float kLambertBandFactors[6] = {1.0f, 0.666666667f, 0.25f, 0.0f, -0.0416666667f, 0.0f};

void phongBandFactors(float n, out float factors[6]) {
  factors[0] = 1.0f;
  factors[1] = (n + 1.0f) / (n + 2.0f);
  factors[2] = n / (n + 3.0f);
  factors[3] = factors[1] * (n - 1.0f) / (n + 4.0f);
  factors[4] = factors[2] * (n - 2.0f) / (n + 5.0f);
  factors[5] = factors[3] * (n - 3.0f) / (n + 6.0f);
}

// Radiance that one lobe, without its colour, makes of SH light.
vec3 shadeLambert3(const vec3 light[9], vec3 normal) { return shConvolvedValue3(light, normal, kLambertBandFactors); }
vec3 shadeLambert4(const vec3 light[16], vec3 normal) { return shConvolvedValue4(light, normal, kLambertBandFactors); }
vec3 shadeLambert5(const vec3 light[25], vec3 normal) { return shConvolvedValue5(light, normal, kLambertBandFactors); }
vec3 shadeLambert6(const vec3 light[36], vec3 normal) { return shConvolvedValue6(light, normal, kLambertBandFactors); }

vec3 shadePhong3(const vec3 light[9], vec3 mirror, float exponent) {
  float factors[6];
  phongBandFactors(exponent, factors);
  return shConvolvedValue3(light, mirror, factors);
}
vec3 shadePhong4(const vec3 light[16], vec3 mirror, float exponent) {
  float factors[6];
  phongBandFactors(exponent, factors);
  return shConvolvedValue4(light, mirror, factors);
}
vec3 shadePhong5(const vec3 light[25], vec3 mirror, float exponent) {
  float factors[6];
  phongBandFactors(exponent, factors);
  return shConvolvedValue5(light, mirror, factors);
}
vec3 shadePhong6(const vec3 light[36], vec3 mirror, float exponent) {
  float factors[6];
  phongBandFactors(exponent, factors);
  return shConvolvedValue6(light, mirror, factors);
}

#endif
