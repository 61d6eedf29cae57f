// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The lobes of math/brdf.h made ready for paths (path_lanes.h): what they ask several times is worked out once.
#pragma once

#include "math/brdf.h"

namespace gloam::reference {

/// Lobes of one kind of surface.
struct LobesReady {
  brdf::Lobes lobes;
  float specular_share = 0.0f;  ///< brdf::specularProbability
  bool black = true;

  LobesReady() = default;
  explicit LobesReady(const brdf::Lobes& given)
      : lobes(given),
        specular_share(brdf::specularProbability(given)),
        black(given.diffuse == glm::vec3(0.0f) && given.specular == glm::vec3(0.0f)) {}
};

}  // namespace gloam::reference
