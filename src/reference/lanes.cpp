// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Compiled for wider vectors too where the compiler can choose at run time. Without fused multiplication, and in the order in
// which it is written: the bits are those of the functions for one (sampler.h, angles.h), on any machine.
#include "reference/lanes.h"

#include "reference/angles.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__linux__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GLOAM_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define GLOAM_WIDE
#endif

namespace gloam::reference {

GLOAM_WIDE void numbersOfLanes(const Sampler::Scramble& scramble, const LaneBits& places, LaneBits& x,
                               LaneBits& y) {
  for (int i = 0; i < kLanes; ++i) {
    const glm::uvec2 n = Sampler::numbers(scramble, places.at[i]);
    x.at[i] = n.x;
    y.at[i] = n.y;
  }
}

GLOAM_WIDE void cosineOfLanes(const LaneFloats& u, const LaneFloats& v, const LaneVectors& normals,
                              LaneVectors& directions) {
  for (int i = 0; i < kLanes; ++i) {
    const glm::vec3 d =
        angles::cosineAbout({normals.x.at[i], normals.y.at[i], normals.z.at[i]}, u.at[i], v.at[i]);
    directions.x.at[i] = d.x;
    directions.y.at[i] = d.y;
    directions.z.at[i] = d.z;
  }
}

GLOAM_WIDE void anglesOfLanes(const LaneVectors& directions, LaneFloats& longitude, LaneFloats& elevation,
                              LaneFloats& cos_elevation) {
  for (int i = 0; i < kLanes; ++i) {
    const float x = directions.x.at[i], z = directions.z.at[i];
    cos_elevation.at[i] = std::sqrt(x * x + z * z);
    longitude.at[i] = angles::turns(z, x);
    elevation.at[i] = angles::turns(directions.y.at[i], cos_elevation.at[i]);
  }
}

}  // namespace gloam::reference
