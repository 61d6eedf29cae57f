// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What bounce rays met, as it is kept between bounces.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace gloam::prt {

/// Mirrors that a ray is followed through at most; and rays are dropped that carry less than this.
inline constexpr int kMostMirrors = 6;
inline constexpr float kLeastThroughput = 1.0e-3f;

/// A surface that sends transfer on. Kept in 24 bytes: all bounces have the same hits, and they are what memory goes into.
struct GatheredHit {
  std::uint32_t point[3];
  std::uint16_t share[2];   ///< of the second and third point; 1 is kHitSteps
  std::uint16_t weight[3];  ///< red, green, blue; kHitSteps is PointHits::scale
  std::uint16_t mirrors;    ///< on the way from the receiver
};
static_assert(sizeof(GatheredHit) == 24);
inline constexpr float kHitSteps = 65535.0f;

/// The sky, seen by way of mirrors.
struct SkyHit {
  glm::vec3 direction;    ///< in which the ray left the scene
  glm::vec3 throughput;   ///< what the mirrors leave of it
  std::uint32_t primary;  ///< direction at the receiver: tile * 16 + lane
  std::uint32_t mirrors;
  float cosine;       ///< max(0, n.s) ds at the receiver
  float solid_angle;  ///< ds; kept where there are matrices
};

/// A hit that sends transfer on through both lobes.
struct GlossyHit {
  std::uint32_t point[3];
  float share[3];           ///< barycentric
  std::uint32_t direction;  ///< of the ray at the receiver: tile * 16 + lane
  std::uint32_t mirrors;
  float cosine;        ///< max(0, n.s) ds at the receiver
  float solid_angle;   ///< ds
  glm::vec3 albedo;    ///< k_d / pi, times what the mirrors leave of it
  glm::vec3 specular;  ///< k_s; 0 where the surface has no matrices, or was followed as a mirror
  float exponent;
  glm::vec3 mirror;  ///< direction from which a mirror would send light along the ray
};

/// Where hits of points that follow one another end.
struct PointHits {
  std::uint32_t end = 0, sky_end = 0;
  float scale = 0.0f;
};

/// A hit before its point's scale is known.
struct RawHit {
  glm::uvec3 points;
  glm::vec3 share;
  glm::vec3 weight;
  std::uint32_t mirrors;
};
/// Weight of a direction of a smaller set, so that its hits stand for what the first pass, which knows better, found blocked.
float directionWeight(float known, double seen, std::size_t tiles);
/// A standard error is not believed to have fallen to less than this part of what the half as many directions had: twice
/// the directions bring it to 0.6 on average (an error of n^-3/4), and a lucky estimate would end a point too soon.
inline constexpr float kSteepestFall = 0.45f;
/// In place of the number of a bounce: all of them.
inline constexpr int kAllPasses = -1;
void packHits(const std::vector<RawHit>& raw, std::vector<GatheredHit>& hits, PointHits& point);

}  // namespace gloam::prt
