// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The one material that the reference and all techniques shade: a Lambert lobe about the normal and a
// normalised Phong lobe about the mirror direction (Segovia, Wald 2008; rows RF-5 and "Conventions").
// math/brdf.glsl has the same functions under the same names.
//
// "Lobe" is the BRDF with its cosine: what multiplies incident radiance. The Phong lobe has no further N.L.
// It may reach below the surface; radiance from there is 0 because the surface itself is in the way: whoever
// shades with lights or rays drops directions below the geometric horizon.
#pragma once

#include <gloam/sh.h>

#include <glm/glm.hpp>

namespace gloam::brdf {

struct Lobes {
  glm::vec3 diffuse{0.0f};   ///< k_d, albedo of the Lambert lobe
  glm::vec3 specular{0.0f};  ///< k_s, integral of the Phong lobe
  float exponent = 1.0f;     ///< n, 1 to kMaxPhongExponent
};

/// Smooth surfaces are drawn with this exponent: a lobe 0.1 degrees wide, which floats still resolve.
inline constexpr float kMaxPhongExponent = 1.0e6f;

/// n = max(1, 2 / roughness^4 - 2), at most kMaxPhongExponent.
float phongExponent(float roughness);
/// k_d = base (1 - metallic), k_s = mix(0.04 specular, base, metallic).
Lobes makeLobes(const glm::vec3& base_color, float metallic, float roughness, float specular = 1.0f);

/// Direction in which a mirror sends the view direction (both point away from the surface).
glm::vec3 mirrorDirection(const glm::vec3& normal, const glm::vec3& to_view);

/// max(0, n.s) / pi in 1/sr: the Lambert lobe without k_d.
float lambertLobe(const glm::vec3& normal, const glm::vec3& direction);
/// (n + 1) / 2 pi max(0, r.s)^n in 1/sr: the Phong lobe without k_s; its integral over the sphere is 1.
float phongLobe(float exponent, const glm::vec3& mirror, const glm::vec3& direction);
/// Both lobes with their colours: radiance out for a unit of irradiance on a plane facing `direction`.
glm::vec3 evaluateLobes(const Lobes& lobes, const glm::vec3& normal, const glm::vec3& to_view,
                        const glm::vec3& direction);

/// Convolution factors of band l: light convolved with a lobe is each band times its factor, taken at the
/// axis. Lambert: A_l / pi = 1, 2/3, 1/4, 0, -1/24, 0 … (any l).
float lambertBandFactor(int l);
/// Phong: (n+1)(n-1)…(n-l+2) / ((n+l+1)(n+l-1)…(n+2)) for odd l, n(n-2)…(n-l+2) / ((n+l+1)…(n+3)) for even l.
float phongBandFactor(int l, float exponent);
/// The same as zonal functions (RF-5's coefficients without k_d and k_s).
sh::Zh lambertZonal(int order);
sh::Zh phongZonal(int order, float exponent);
/// Radiance that one lobe, without its colour, makes of SH light.
glm::vec3 shadeLambert(const sh::ShRgb& light, const glm::vec3& normal);
glm::vec3 shadePhong(const sh::ShRgb& light, const glm::vec3& mirror, float exponent);
/// Radiance towards the view that both lobes give under SH light.
glm::vec3 shade(const Lobes& lobes, const sh::ShRgb& light, const glm::vec3& normal,
                const glm::vec3& to_view);

// ---- Sampling (path tracing) ----

/// Densities over solid angle, in 1/sr, of the samplers in math/sampling.h aimed at the lobes.
float lambertPdf(const glm::vec3& normal, const glm::vec3& direction);
float phongPdf(float exponent, const glm::vec3& mirror, const glm::vec3& direction);
glm::vec3 sampleLambert(const glm::vec3& normal, const glm::vec2& u);
glm::vec3 samplePhong(float exponent, const glm::vec3& mirror, const glm::vec2& u);

struct LobeSample {
  glm::vec3 direction{0.0f};
  glm::vec3 value{0.0f};  ///< evaluateLobes in that direction; weight a path by value / pdf
  float pdf = 0.0f;       ///< of both lobes together, 1/sr; 0: both lobes are black, the path ends
};
/// Chance of taking the Phong lobe: its share of the luminance of k_d + k_s.
float specularProbability(const Lobes& lobes);
/// Picks a lobe with u.z, a direction in it with (u.x, u.y), all in [0, 1).
LobeSample sampleLobes(const Lobes& lobes, const glm::vec3& normal, const glm::vec3& to_view,
                       const glm::vec3& u);
/// Density with which sampleLobes takes a direction, 1/sr.
float lobesPdf(const Lobes& lobes, const glm::vec3& normal, const glm::vec3& to_view,
               const glm::vec3& direction);

}  // namespace gloam::brdf
