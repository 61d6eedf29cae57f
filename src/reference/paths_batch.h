// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What paths carry with them: for paths.cpp and paths_light.cpp alone.
#pragma once

#include "reference/path_lanes.h"
#include "reference/paths.h"

namespace gloam::reference {

// Pairs of random numbers: one for the picture, then so many a vertex.
enum Pair : std::uint32_t { kLobes, kEnvironment, kEmitterPoint, kEmitter, kLampAndRoulette, kPairsAVertex };
inline constexpr std::uint32_t kPixelPair = 0;
inline constexpr std::uint32_t kFirstShotPair = 1u << 16;  // two a vertex, beyond all others

struct Paths::Batch {
  Batch(std::size_t& rays_traced, std::vector<trace::LoggedRay>* rays_logged, const Sampler& first_sampler)
      : rays(rays_traced), log(rays_logged), sampler(first_sampler) {}

  std::size_t& rays;
  std::vector<trace::LoggedRay>* log;
  Sampler sampler;  // of the first sample; all share its scrambles
  std::span<PathLight> light;
  int count = 0;  // of lanes in use: the first so many
  int depth = 0;
  Sources sources;
  PathLanes lanes;
  Surfaces::Arrivals arrivals;
  LightLanes toward;
  SkyPlaces sky_by_light, sky_by_lobes;
  LaneVectors step_light;  // that steps find in a sky of radiance 1
  struct Shot {
    PathLanes lanes{};
    Surfaces::Arrivals arrivals{};
    ShotLanes shots{};
  };
  std::unique_ptr<Shot> shot;  // where lamps send rays

  Sampler::Scramble scramble(Pair which) const {
    return sampler.scramble(1u + std::uint32_t(depth) * kPairsAVertex + which);
  }
  Sampler::Scramble shotScramble(std::uint32_t which) const {
    return sampler.scramble(kFirstShotPair + std::uint32_t(depth) * 2u + which);
  }
  std::uint32_t used() const { return (1u << count) - 1u; }
  std::uint32_t going() const { return lanes.going & used(); }
  void add(int lane, LightPath direct, const glm::vec3& radiance) { addAfter(lane, direct, depth, radiance); }
  void addAfter(int lane, LightPath direct, int bounces, const glm::vec3& radiance) {
    light[std::size_t(lanes.slot.at[lane])][std::size_t(pathAfter(direct, bounces))] += radiance;
  }
  trace::Ray stepOf(int lane) const { return {lanes.origin.get(lane), lanes.direction.get(lane)}; }
  void record(const trace::Ray& ray, bool occlusion) {
    ++rays;
    if (log) log->push_back({ray, occlusion});
  }
};

}  // namespace gloam::reference
