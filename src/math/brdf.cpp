// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// RF-5: Lambert and normalised Phong lobes and their spherical harmonics (Segovia, Wald 2008; Ramamoorthi, Hanrahan
// 2002). Differs from the paper in the normalisation, which is that of the whole lobe: (n + 1) / 2 pi.
#include "math/brdf.h"

#include <algorithm>
#include <cmath>

#include "math/sampling.h"

namespace gloam::brdf {
namespace {

float luminance(const glm::vec3& color) {
  return glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

/// cos^exponent; pow(0, 0) cannot occur because exponents are at least 1.
float power(float cosine, float exponent) {
  return cosine > 0.0f ? std::pow(cosine, exponent) : 0.0f;
}

}  // namespace

float phongExponent(float roughness) {
  const float alpha = roughness * roughness;
  const float exponent = 2.0f / std::max(alpha * alpha, 1e-12f) - 2.0f;
  return std::clamp(exponent, 1.0f, kMaxPhongExponent);
}

Lobes makeLobes(const glm::vec3& base_color, float metallic, float roughness, float specular) {
  return {base_color * (1.0f - metallic), glm::mix(glm::vec3(0.04f * specular), base_color, metallic),
          phongExponent(roughness)};
}

glm::vec3 mirrorDirection(const glm::vec3& normal, const glm::vec3& to_view) {
  return 2.0f * glm::dot(normal, to_view) * normal - to_view;
}

float lambertLobe(const glm::vec3& normal, const glm::vec3& direction) {
  return std::max(0.0f, glm::dot(normal, direction)) / sampling::kPi;
}

float phongLobe(float exponent, const glm::vec3& mirror, const glm::vec3& direction) {
  return (exponent + 1.0f) / (2.0f * sampling::kPi) * power(glm::dot(mirror, direction), exponent);
}

glm::vec3 evaluateLobes(const Lobes& lobes, const glm::vec3& normal, const glm::vec3& to_view,
                        const glm::vec3& direction) {
  return lobes.diffuse * lambertLobe(normal, direction) +
         lobes.specular * phongLobe(lobes.exponent, mirrorDirection(normal, to_view), direction);
}

float lambertBandFactor(int l) {
  if (l == 1) return 2.0f / 3.0f;
  if (l % 2 != 0) return 0.0f;
  // 2 (-1)^(l/2 - 1) / ((l + 2)(l - 1)) * l! / (2^l ((l/2)!)^2), the last factor as a product of (2i - 1) / 2i.
  double ratio = 1.0;
  for (int i = 1; i <= l / 2; ++i) ratio *= (2.0 * i - 1.0) / (2.0 * i);
  const double sign = (l / 2) % 2 != 0 ? 1.0 : -1.0;
  return static_cast<float>(sign * 2.0 / ((l + 2.0) * (l - 1.0)) * ratio);
}

float phongBandFactor(int l, float exponent) {
  const double n = exponent;  // band l follows from band l - 2 by (n - l + 2) / (n + l + 1)
  double factor = l % 2 != 0 ? (n + 1.0) / (n + 2.0) : 1.0;
  for (int i = 2 + l % 2; i <= l; i += 2) factor *= (n - i + 2.0) / (n + i + 1.0);
  return static_cast<float>(factor);
}

sh::Zh lambertZonal(int order) {
  sh::Zh zonal = sh::clampedCosine(order);
  for (int l = 0; l < order; ++l) zonal[l] = lambertBandFactor(l) / sh::zonalFactor(l);
  return zonal;
}

sh::Zh phongZonal(int order, float exponent) {
  sh::Zh zonal = sh::clampedCosine(order);
  for (int l = 0; l < order; ++l) zonal[l] = phongBandFactor(l, exponent) / sh::zonalFactor(l);
  return zonal;
}

glm::vec3 shadeLambert(const sh::ShRgb& light, const glm::vec3& normal) {
  return sh::dot(light, sh::rotateZonal(lambertZonal(light.order), normal));
}

glm::vec3 shadePhong(const sh::ShRgb& light, const glm::vec3& mirror, float exponent) {
  return sh::dot(light, sh::rotateZonal(phongZonal(light.order, exponent), mirror));
}

glm::vec3 shade(const Lobes& lobes, const sh::ShRgb& light, const glm::vec3& normal,
                const glm::vec3& to_view) {
  return lobes.diffuse * shadeLambert(light, normal) +
         lobes.specular * shadePhong(light, mirrorDirection(normal, to_view), lobes.exponent);
}

float lambertPdf(const glm::vec3& normal, const glm::vec3& direction) {
  return lambertLobe(normal, direction);
}

float phongPdf(float exponent, const glm::vec3& mirror, const glm::vec3& direction) {
  return phongLobe(exponent, mirror, direction);
}

glm::vec3 sampleLambert(const glm::vec3& normal, const glm::vec2& u) {
  return sampling::frame(normal) * sampling::cosineHemisphere(u);
}

glm::vec3 samplePhong(float exponent, const glm::vec3& mirror, const glm::vec2& u) {
  return sampling::frame(mirror) * sampling::phongLobe(u, exponent);
}

float specularProbability(const Lobes& lobes) {
  const float diffuse = luminance(lobes.diffuse), specular = luminance(lobes.specular);
  return diffuse + specular > 0.0f ? specular / (diffuse + specular) : 0.0f;
}

float lobesPdf(const Lobes& lobes, const glm::vec3& normal, const glm::vec3& to_view,
               const glm::vec3& direction) {
  const float specular = specularProbability(lobes);
  return (1.0f - specular) * lambertPdf(normal, direction) +
         specular * phongPdf(lobes.exponent, mirrorDirection(normal, to_view), direction);
}

LobeSample sampleLobes(const Lobes& lobes, const glm::vec3& normal, const glm::vec3& to_view,
                       const glm::vec3& u) {
  LobeSample sample;
  if (luminance(lobes.diffuse) + luminance(lobes.specular) <= 0.0f) return sample;
  const glm::vec2 square(u.x, u.y);
  sample.direction = u.z < specularProbability(lobes)
                         ? samplePhong(lobes.exponent, mirrorDirection(normal, to_view), square)
                         : sampleLambert(normal, square);
  sample.value = evaluateLobes(lobes, normal, to_view, sample.direction);
  sample.pdf = lobesPdf(lobes, normal, to_view, sample.direction);
  return sample;
}

}  // namespace gloam::brdf
