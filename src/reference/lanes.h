// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What paths that walk side by side work out in the same way, sixteen at once: loops that a compiler turns into vector code.
#pragma once

#include <glm/glm.hpp>

#include "reference/sampler.h"

namespace gloam::reference {

inline constexpr int kLanes = 16;

struct alignas(64) LaneFloats {
  float at[kLanes];
};
struct alignas(64) LaneInts {
  std::int32_t at[kLanes];
};
struct alignas(64) LaneBits {
  std::uint32_t at[kLanes];
};
struct LaneVectors {
  LaneFloats x, y, z;
  void set(int lane, const glm::vec3& v) {
    x.at[lane] = v.x;
    y.at[lane] = v.y;
    z.at[lane] = v.z;
  }
  glm::vec3 get(int lane) const { return {x.at[lane], y.at[lane], z.at[lane]}; }
};

/// Sampler::numbers of one pair for samples given by Sampler::place.
void numbersOfLanes(const Sampler::Scramble& scramble, const LaneBits& places, LaneBits& x, LaneBits& y);
/// Directions about normals with density cosine / pi, from two numbers in [0, 1).
void cosineOfLanes(const LaneFloats& u, const LaneFloats& v, const LaneVectors& normals,
                   LaneVectors& directions);
/// Equirectangular coordinates in turns: longitude -1/2 to 1/2 (atan2(z, x)), elevation -1/4 to 1/4; and its cosine.
void anglesOfLanes(const LaneVectors& directions, LaneFloats& longitude, LaneFloats& elevation,
                   LaneFloats& cos_elevation);

}  // namespace gloam::reference
