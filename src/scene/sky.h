// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a sky made by code consists of, before it is painted or projected.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "scene/named_values.h"

namespace gloam {

/// Azimuth: 0 towards +Z, growing counter-clockwise as seen from above (90 degrees: +X).
glm::vec3 skyDirection(float elevation_deg, float azimuth_deg);

struct SkyDisc {
  glm::vec3 axis;
  float half_angle_rad;
  glm::vec3 irradiance;  ///< on a small plane facing it
};

struct SkyParts {
  std::function<glm::vec3(const glm::vec3& direction)> radiance;  ///< without what follows
  std::vector<SkyDisc> discs;
  /// The half below the horizon is what level ground of that albedo sends back of all the rest.
  std::optional<glm::vec3> ground_albedo;
  float rotation_rad = 0.0f, intensity = 1.0f;
};

/// A sky by name ("preetham") with its values. Throws Error that lists the names, or names a value.
SkyParts skyParts(NamedValues& values);

}  // namespace gloam
