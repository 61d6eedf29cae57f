// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Preetham, Shirley, Smits 1999, "A Practical Analytic Model for Daylight", appendices A.1 and A.2: Perez's five-parameter
// distribution for luminance and both chromaticities, its coefficients linear in turbidity, the zenith's values polynomial
// in turbidity and the sun's angle. The sun's colour is taken at one wavelength for each of red, green and blue through
// their formulas for Rayleigh and Angstrom scattering (instead of spectral tables; ozone, gases and water vapour left out).
#include "scene/preetham.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kSunKilolux = 128.0f;  // above the atmosphere

float cubic(float theta, float c3, float c2, float c1, float c0) {
  return ((c3 * theta + c2) * theta + c1) * theta + c0;
}

glm::vec3 rec709FromXyz(const glm::vec3& xyz) {
  const glm::mat3 m(3.2404542f, -0.9692660f, 0.0556434f, -1.5371385f, 1.8760108f, -0.2040259f, -0.4985314f,
                    0.0415560f, 1.0572252f);
  return glm::max(m * xyz, glm::vec3(0.0f));
}

}  // namespace

float PreethamSky::Perez::operator()(float cos_theta, float gamma_rad, float cos_gamma) const {
  return (1.0f + a * std::exp(b / cos_theta)) *
         (1.0f + c * std::exp(d * gamma_rad) + e * cos_gamma * cos_gamma);
}

PreethamSky::PreethamSky(const glm::vec3& toward_sun, float turbidity)
    : toward_sun_(toward_sun),
      turbidity_(turbidity),
      perez_{{0.1787f * turbidity - 1.4630f, -0.3554f * turbidity + 0.4275f, -0.0227f * turbidity + 5.3251f,
              0.1206f * turbidity - 2.5771f, -0.0670f * turbidity + 0.3703f},
             {-0.0193f * turbidity - 0.2592f, -0.0665f * turbidity + 0.0008f, -0.0004f * turbidity + 0.2125f,
              -0.0641f * turbidity - 0.8989f, -0.0033f * turbidity + 0.0452f},
             {-0.0167f * turbidity - 0.2608f, -0.0950f * turbidity + 0.0092f, -0.0079f * turbidity + 0.2102f,
              -0.0441f * turbidity - 1.6537f, -0.0109f * turbidity + 0.0529f}} {
  const float t = turbidity, theta = std::acos(std::clamp(toward_sun.y, 0.0f, 1.0f));
  const float chi = (4.0f / 9.0f - t / 120.0f) * (kPi - 2.0f * theta);
  const float zenith[3] = {(4.0453f * t - 4.9710f) * std::tan(chi) - 0.2155f * t + 2.4192f,
                           t * t * cubic(theta, 0.00166f, -0.00375f, 0.00209f, 0.0f) +
                               t * cubic(theta, -0.02903f, 0.06377f, -0.03202f, 0.00394f) +
                               cubic(theta, 0.11693f, -0.21196f, 0.06052f, 0.25886f),
                           t * t * cubic(theta, 0.00275f, -0.00610f, 0.00317f, 0.0f) +
                               t * cubic(theta, -0.04214f, 0.08970f, -0.04153f, 0.00516f) +
                               cubic(theta, 0.15346f, -0.26756f, 0.06670f, 0.26688f)};
  for (int i = 0; i < 3; ++i) scale_[i] = std::max(0.0f, zenith[i]) / perez_[i](1.0f, theta, std::cos(theta));
}

glm::vec3 PreethamSky::radiance(const glm::vec3& direction) const {
  // The distribution is undefined below the horizon and stiff just above it.
  const float cos_theta = std::max(direction.y, 0.01f);
  const float cos_gamma = std::clamp(glm::dot(direction, toward_sun_), -1.0f, 1.0f);
  const float gamma = std::acos(cos_gamma);
  float value[3];
  for (int i = 0; i < 3; ++i) value[i] = scale_[i] * perez_[i](cos_theta, gamma, cos_gamma);
  const float luminance = std::max(0.0f, value[0]) / kKilocandelasPerUnit;
  const float x = value[1], y = std::max(value[2], 1e-3f);
  return rec709FromXyz(luminance * glm::vec3(x / y, 1.0f, (1.0f - x - y) / y));
}

glm::vec3 PreethamSky::sunIrradiance() const {
  const float theta = std::acos(std::clamp(toward_sun_.y, 0.0f, 1.0f));
  // Relative optical air mass.
  const float mass = 1.0f / (std::cos(theta) + 0.15f * std::pow(93.885f - glm::degrees(theta), -1.253f));
  const float beta = std::max(0.0f, 0.04608f * turbidity_ - 0.04586f);
  const glm::vec3 wavelength_um(0.615f, 0.535f, 0.455f);
  glm::vec3 irradiance(0.0f);
  for (int c = 0; c < 3; ++c) {
    const float rayleigh = 0.008735f * std::pow(wavelength_um[c], -4.08f);
    const float aerosol = beta * std::pow(wavelength_um[c], -1.3f);
    irradiance[c] = kSunKilolux * std::exp(-(rayleigh + aerosol) * mass);
  }
  return irradiance / kKilocandelasPerUnit;
}

}  // namespace gloam
