// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What paths carry with them: for paths.cpp and paths_light.cpp alone.
#pragma once

#include <limits>

#include "reference/paths.h"

namespace gloam::reference {

// Pairs of random numbers: one for the picture, then so many a vertex.
enum Pair : std::uint32_t { kLobes, kEnvironment, kEmitterPoint, kEmitter, kLampAndRoulette, kPairsAVertex };
inline constexpr std::uint32_t kPixelPair = 0;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

inline bool isBlack(const glm::vec3& v) {
  return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f;
}

/// What a path carries from vertex to vertex.
struct Paths::Lane {
  PathLight* light;
  std::uint32_t place;  // Sampler::place
  Vertex vertex;
  PointLobes lobes;
  glm::vec3 origin;  // of rays that leave the vertex
  glm::vec3 throughput;
  EnvironmentSampler::Block block;
  // The step by lobes.
  glm::vec3 direction, step_throughput;
  float pdf;  // 0: no step

  void setUp(const glm::vec3& to_view) {
    lobes = PointLobes(*vertex.lobes, vertex.normal, to_view);
    origin = vertex.rayOrigin();
  }
};

struct Paths::Batch {
  std::size_t& rays;
  std::vector<trace::LoggedRay>* log;
  Sampler sampler;  // of the first sample; all share its scrambles
  Lane* active[kLanes];
  int count = 0;
  int depth = 0;
  bool same_vertex = false;  // all stand at one point that has no textures
  Sources sources;
  struct Shadow {
    trace::Ray ray;
    glm::vec3 light;
    Lane* lane;
  };
  Shadow* shadows;  // room for all lanes
  int shadow_count = 0;
  EnvironmentSampler::Place skies[kLanes];  // where the active lanes' steps look

  std::span<Lane*> all() { return {active, std::size_t(count)}; }
  std::uint32_t number(Pair which) const { return 1u + std::uint32_t(depth) * kPairsAVertex + which; }
  /// Random numbers of the active lanes.
  void numbers(Pair which, LaneBits& x, LaneBits& y) const {
    LaneBits places;
    for (int i = 0; i < kLanes; ++i) places.at[i] = active[i < count ? i : 0]->place;
    numbersOfLanes(sampler.scramble(number(which)), places, x, y);
  }
  void add(Lane& lane, LightPath direct, const glm::vec3& radiance) {
    (*lane.light)[std::size_t(direct) + (depth > 0 ? 1u : 0u)] += radiance;
  }
  void push(Lane& lane, const glm::vec3& direction, float t_far, const glm::vec3& light) {
    Shadow& shadow = shadows[shadow_count++];
    shadow.ray.origin = lane.origin;
    shadow.ray.direction = direction;
    shadow.ray.t_near = 0.0f;
    shadow.ray.t_far = t_far;
    shadow.light = light;
    shadow.lane = &lane;
  }
  void record(const trace::Ray& ray, bool occlusion) {
    ++rays;
    if (log) log->push_back({ray, occlusion});
  }
};

}  // namespace gloam::reference
