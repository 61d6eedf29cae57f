// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light that a lamp throws on what stands right beside it, met from the lamp's side: rays shot from lamps, evenly over all
// directions that they shine to. Where they land, light over density does not know of the distance squared that makes such
// spots so bright, and so hard for paths from the eye to find.
#pragma once

#include <span>

#include "reference/distribution.h"
#include "reference/lamps.h"
#include "trace/tracer.h"

namespace gloam::reference {

class LampShots {
 public:
  LampShots() = default;
  /// Looks around from each lamp and chooses those much nearer to something than to most of what is `seen` by the camera; sets
  /// Lamp::shot_density of these. Nothing seen: none.
  LampShots(std::vector<Lamp>& lamps, const trace::Tracer& tracer, std::span<const glm::vec3> seen);

  bool empty() const { return choice_.empty(); }
  struct Shot {
    int lamp = 0;
    glm::vec3 direction{0.0f};  ///< unit, away from the lamp
  };
  /// With density Lamp::shot_density over solid angle, the choice of the lamp included.
  Shot shoot(std::uint32_t number, const glm::vec2& u) const;

 private:
  struct Cone {
    glm::mat3 world_from_cone{1.0f};
    float cosine = -1.0f;  ///< of its half-angle; -1: all directions
  };
  std::vector<Cone> cones_;
  Distribution choice_;
};

}  // namespace gloam::reference
