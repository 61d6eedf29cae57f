// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Distant light for paths: its radiance in a direction, directions in which there is much of it, and their density.
#pragma once

#include <gloam/scene.h>
#include <gloam/sh.h>

#include "reference/sky_lanes.h"

namespace gloam::reference {

/// The environment's pixels as radianceFrom() reads them (bilinear), or its projection to some bands of spherical harmonics,
/// which may be negative. Keeps no reference to the environment.
class EnvironmentSampler {
 public:
  /// order 0: the pixels; 1 to 6: that many bands of projectEnvironment, no window.
  EnvironmentSampler(const Environment& environment, int order);

  /// No light from anywhere. Then only from() may be asked.
  bool black() const { return sky_.blocks.empty(); }

  struct Light {
    glm::vec3 radiance{0.0f};
    float pdf = 0.0f;  ///< with which sample() takes the direction, 1/sr; positive wherever there is light
  };
  /// Out of one unit direction.
  Light from(const glm::vec3& direction) const;

  /// Sixteen at once. Where directions lie.
  void find(const LaneVectors& directions, SkyPlaces& places) const { placesOf(sky_, directions, places); }
  /// Directions by their light.
  void choose(const Sampler::Scramble& scramble, const LaneBits& numbers, SkyPlaces& places,
              LaneVectors& directions) const {
    chooseIn(sky_, scramble, numbers, places, directions);
  }
  /// Sends for the light of a lane: radiance() is better asked some time later.
  void sendFor(const SkyPlaces& places, int lane) const {
    if (projection_.order == 0) reference::sendFor(sky_, places, lane);
  }
  /// Out of those lanes' directions, a bit each.
  void radiance(const SkyPlaces& places, const LaneVectors& directions, std::uint32_t mask,
                LaneVectors& light) const;

 private:
  struct Texels {                    // with a border around
    std::vector<SkyTexel> radiance;  // empty: nothing of it is asked
    std::vector<float> importance;
  };
  Texels fillPixels(const Environment& environment);
  Texels fillProjection(const Environment& environment, int order);
  void fillCells(const std::vector<SkyTexel>& texels);
  /// Its texels: upper left, lower left, upper right, lower right.
  const SkyTexel* cell(int x, int y) const {
    return &sky_.texels[2 * (std::size_t(y) * std::size_t(sky_.width + 1) + std::size_t(x))];
  }

  SkyTable sky_;
  sh::ShRgb projection_;  // order 0: pixels are the light
};

}  // namespace gloam::reference
