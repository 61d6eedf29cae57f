// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Paths of one scene: all that they need to know, and the walk itself (paths.cpp).
#pragma once

#include <gloam/reference.h>

#include <memory>
#include <span>

#include "reference/emitters.h"
#include "reference/environment_sampler.h"
#include "reference/integrator.h"
#include "reference/lamp_shots.h"
#include "reference/sampler.h"
#include "reference/surfaces.h"

namespace gloam::reference {

/// Which kinds of light are gathered at a vertex.
struct Sources {
  bool environment = false, lamps = false, emitters = false;
  bool any() const { return environment || lamps || emitters; }
};

struct PathLanes;
struct ShotLanes;

class Paths {
 public:
  /// `environment` is the light, as ReferenceOptions::environment_order asks for it.
  Paths(const Scene& scene, const PosedScene& posed, std::shared_ptr<const EnvironmentSampler> environment,
        const ReferenceOptions& options, Sampling sampling, const Progress& progress);
  Paths(const Paths&) = delete;
  /// Lets lamps send rays that are near to something (lamp_shots.h). `seen`: places that the camera sees.
  void shootNear(std::span<const glm::vec3> seen);

  /// Samples first, first + 1 … of a point that is no background. `light` is overwritten.
  void trace(const CameraPoint& point, std::uint32_t pixel, std::uint32_t first, std::span<PathLight> light,
             std::size_t& rays, std::vector<trace::LoggedRay>* log) const;

  const trace::Tracer& tracer() const { return tracer_; }
  const Surfaces& surfaces() const { return surfaces_; }
  Sources direct() const { return direct_; }
  Sources indirect() const { return indirect_; }
  int bounces() const { return last_depth_; }  ///< that paths make at most

 private:
  struct Batch;
  void begin(Batch& batch, const CameraPoint& point, std::uint32_t first, std::span<PathLight> light) const;
  void walk(Batch& batch) const;
  void fromLamps(Batch& batch) const;
  void fromEnvironment(Batch& batch) const;
  void fromEmitters(Batch& batch) const;
  std::uint32_t shoot(Batch& batch, PathLanes& lanes, ShotLanes& shots) const;
  void fromShots(Batch& batch) const;
  template <class Free>
  std::uint32_t shadowRays(Batch& batch, const Free& whenFree) const;
  void castShadows(Batch& batch, LightPath direct) const;
  void addSky(Batch& batch, const SkyPlaces& places, const LaneVectors& directions, std::uint32_t free,
              const LaneVectors& share) const;
  void findSky(Batch& batch) const;
  void finish(Batch& batch) const;
  float densityOf(const Batch& batch, int lane, const trace::Hit& hit) const;
  bool survives(Batch& batch, int lane, std::uint32_t number) const;
  void advance(Batch& batch, bool go_on) const;
  void traceSteps(Batch& batch, trace::Hit* hits, bool go_on) const;
  void addEmission(Batch& batch, int lane, const trace::Hit& hit) const;
  float weight(float pdf, float other_pdf) const {
    const float ratio = other_pdf / pdf;
    return both_ ? 1.0f / (1.0f + ratio * ratio) : 1.0f;
  }

  trace::Tracer tracer_;
  Surfaces surfaces_;
  std::shared_ptr<const EnvironmentSampler> environment_;
  Emitters emitters_;
  std::vector<Lamp> lamps_;
  LampShots shots_;
  Sources direct_, indirect_;
  int last_depth_ = 0;
  std::uint64_t seed_ = 0;
  bool sample_lights_ = true, sample_lobes_ = true, both_ = true;
};

}  // namespace gloam::reference
