// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Distant lights in spherical harmonics (SH-2, SH-4): a disc is zonal, its coefficients are integrals of Legendre polynomials
// over the cone; gradients are exact; a sky is integrated by Gauss-Legendre nodes in the sine of the elevation, each half apart
// since it may jump at the horizon, and equal steps around.
#include <gloam/lights.h>

#include <algorithm>
#include <cmath>

#include "math/quadrature.h"
#include "scene/environment.h"

namespace gloam {
namespace {

constexpr float kPi = 3.14159265f;

glm::mat3 turnedAboutY(float angle_rad) {
  const float c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c, 0.0f, -s, 0.0f, 1.0f, 0.0f, s, 0.0f, c};
}

sh::ShRgb projectFunction(const std::function<glm::vec3(const glm::vec3&)>& function) {
  constexpr int kHeights = 40, kAround = 80;
  static const GaussLegendre<double> nodes(kHeights);
  sh::ShRgb sum(sh::kMaxOrder);
  for (const double half : {-1.0, 1.0}) {
    for (int j = 0; j < kHeights; ++j) {
      const double y = 0.5 * (half + nodes.nodes[std::size_t(j)]);
      const double r = std::sqrt(std::max(0.0, 1.0 - y * y));
      const auto weight = float(0.5 * nodes.weights[std::size_t(j)] * 2.0 * double(kPi) / kAround);
      for (int i = 0; i < kAround; ++i) {
        const double phi = 2.0 * double(kPi) * (i + 0.5) / kAround;
        const glm::vec3 d(r * std::sin(phi), y, r * std::cos(phi));
        const glm::vec3 radiance = weight * function(d);
        const sh::Sh basis = sh::evaluate(sh::kMaxOrder, d);
        for (int k = 0; k < basis.size(); ++k) sum[k] += radiance * basis[k];
      }
    }
  }
  return sum;
}

/// Of a function or a map, before its rotation and intensity.
sh::ShRgb knownProjection(const DistantLight& light) {
  if (light.known_sh) return *light.known_sh;
  if (light.kind == DistantLight::Kind::kFunction) return projectFunction(light.function);
  return projectEnvironment(*light.map, sh::kMaxOrder);
}

}  // namespace

glm::vec3 discRadiance(const glm::vec3& irradiance, float radius_rad) {
  const float sine = radius_rad < 0.5f * kPi ? std::sin(radius_rad) : 1.0f;
  return irradiance / (kPi * sine * sine);
}

glm::vec3 radianceFrom(const DistantLight& light, const glm::vec3& direction) {
  const auto turnedBack = [&] { return glm::transpose(turnedAboutY(light.rotation_rad)) * direction; };
  switch (light.kind) {
    case DistantLight::Kind::kDisc: {
      // An angle of 0.05 degrees is lost in the cosine's last bits, not in the chord.
      const float chord = glm::length(direction - light.direction);
      return 2.0f * std::asin(std::min(1.0f, 0.5f * chord)) <= light.radius_rad ? light.radiance
                                                                                : glm::vec3(0.0f);
    }
    case DistantLight::Kind::kConstant:
      return light.radiance;
    case DistantLight::Kind::kGradient:
      return glm::mix(light.horizon, direction.y >= 0.0f ? light.zenith : light.nadir, std::abs(direction.y));
    case DistantLight::Kind::kFunction:
      return light.intensity * light.function(turnedBack());
    case DistantLight::Kind::kMap:
      return light.intensity * gloam::radianceFrom(*light.map, turnedBack());
  }
  return glm::vec3(0.0f);
}

sh::ShRgb projectLight(const DistantLight& light, int order) {
  switch (light.kind) {
    case DistantLight::Kind::kDisc:
      return sh::colored(sh::disc(order, light.direction, light.radius_rad), light.radiance);
    case DistantLight::Kind::kConstant:
      return sh::constantSky(order, light.radiance);
    case DistantLight::Kind::kGradient:
      return sh::gradientSky(order, light.zenith, light.horizon, light.nadir);
    default:
      break;
  }
  sh::ShRgb projected = sh::truncated(knownProjection(light), order);
  projected *= glm::vec3(light.intensity);
  return light.rotation_rad == 0.0f ? projected : sh::rotate(turnedAboutY(light.rotation_rad), projected);
}

sh::ShRgb projectLights(std::span<const DistantLight> lights, int order) {
  sh::ShRgb sum(order);
  for (const DistantLight& light : lights) sum += projectLight(light, order);
  return sum;
}

}  // namespace gloam
