// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace gloam {

/// Clear daylight after Preetham, Shirley and Smits 1999. Radiance in units of kKilocandelasPerUnit, chosen so that
/// white paper lying in the sun of a clear noon has a radiance near 1.
class PreethamSky {
 public:
  static constexpr float kKilocandelasPerUnit = 32.0f;

  /// `toward_sun` is unit, with y > 0; turbidity 1.7 (very clear) to 10 (hazy).
  PreethamSky(const glm::vec3& toward_sun, float turbidity);

  /// Radiance of the sky without the sun; directions below the horizon are taken at the horizon.
  glm::vec3 radiance(const glm::vec3& direction) const;
  /// Irradiance of the sun on a plane that faces it.
  glm::vec3 sunIrradiance() const;

 private:
  struct Perez {
    float a, b, c, d, e;
    float operator()(float cos_theta, float gamma_rad, float cos_gamma) const;
  };

  glm::vec3 toward_sun_;
  float turbidity_;
  Perez perez_[3];  // luminance Y, chromaticities x, y
  float scale_[3];  // zenith value over the distribution at the zenith
};

}  // namespace gloam
