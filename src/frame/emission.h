// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/sh.h>

#include <cstdint>
#include <vector>

namespace gloam::frame {

/// A point of a surface that lights a proxy, where it is in this frame.
struct EmissionPoint {
  glm::vec3 position{0.0f};  ///< world, metres
  float sends = 0.0f;        ///< 0: there is none, 1
  glm::vec3 normal{0.0f};    ///< unit, outward
  float unused = 0.0f;
};

/// Proxies of a thing taken together, coarsest first: a level holds each of them once, in groups of their numbers within the thing.
using ProxyLevels = std::vector<std::vector<std::vector<int>>>;

/// What a proxy sends besides where it stands (FrameInputs::proxies, in their order).
struct ProxyEmission {
  int object = 0;                       ///< proxies of one number are neighbours in the list and one thing
  int first = 0, count = 0;             ///< that thing's proxies
  glm::mat3 world_from_shape{1.0f};     ///< orthogonal: the axes of the coefficients
  const sh::ShRgb* albedo = nullptr;    ///< four bands
  const sh::ShRgb* glow = nullptr;      ///< four bands
  const ProxyLevels* levels = nullptr;  ///< of its thing; null: none
};

/// A rectangle of something that has no proxies: ground, a wall.
struct Patch {
  glm::vec3 center{0.0f};
  glm::vec3 half_u{0.0f}, half_v{0.0f};  ///< from its middle to the middle of its sides
  glm::vec3 normal{0.0f};                ///< unit; it sends to that side
  glm::vec3 albedo{0.5f};
  glm::vec3 glow{0.0f};   ///< radiance, of those that shine by themselves
  bool enclosed = false;  ///< in a closed room of what has no spheres: nothing from far away meets it
};

/// Valid as long as who posed it keeps it.
struct Emission {
  int points_each = 0;  ///< a proxy
  std::vector<EmissionPoint> points;
  std::vector<ProxyEmission> proxies;
  /// Bit i of proxy p, in `words` words: it meets proxy first + i of its own thing; itself, too.
  int words = 0;
  std::vector<std::uint32_t> meets;
  bool glows = false;  ///< any
  std::vector<Patch> sending_patches, blocking_patches, glowing_patches;
};

}  // namespace gloam::frame
