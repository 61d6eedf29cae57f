// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What paths that walk side by side carry, sixteen at once, one a lane of vectors (lanes_simd.h).
#pragma once

#include <cstdint>
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
  bool isZero(int lane) const { return x.at[lane] == 0.0f && y.at[lane] == 0.0f && z.at[lane] == 0.0f; }
};

/// Four floats a lane, written lane by lane and read by columns.
struct alignas(64) LaneRows {
  float at[kLanes][4];
};

/// Sampler::numbers of one pair for samples given by Sampler::place.
void numbersOfLanes(const Sampler::Scramble& scramble, const LaneBits& places, LaneBits& x, LaneBits& y);

}  // namespace gloam::reference
