// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Paths of one scene: all that they need to know, and the walk itself (paths.cpp).
#pragma once

#include <gloam/reference.h>

#include <memory>

#include "reference/emitters.h"
#include "reference/environment_sampler.h"
#include "reference/integrator.h"
#include "reference/lamps.h"
#include "reference/sampler.h"
#include "reference/surfaces.h"
#include "scene/camera_rays.h"

namespace gloam::reference {

/// Which kinds of light are gathered at a vertex.
struct Sources {
  bool environment = false, lamps = false, emitters = false;
  bool any() const { return environment || lamps || emitters; }
};

class Paths {
 public:
  /// `environment` is the light, as ReferenceOptions::environment_order asks for it.
  Paths(const Scene& scene, const PosedScene& posed, std::shared_ptr<const EnvironmentSampler> environment,
        const ReferenceOptions& options, Sampling sampling, const Progress& progress);
  Paths(const Paths&) = delete;

  PathLight trace(const CameraPoint& point, const Sampler& sampler, std::size_t& rays,
                  std::vector<trace::LoggedRay>* log) const;

  const trace::Tracer& tracer() const { return tracer_; }
  const Surfaces& surfaces() const { return surfaces_; }
  Sources direct() const { return direct_; }
  Sources indirect() const { return indirect_; }

 private:
  struct Walk;
  struct Step;
  void begin(Walk& walk, const CameraPoint& point) const;
  void fromEnvironment(Walk& walk, const EnvironmentSampler::Block& block) const;
  void fromEmitters(Walk& walk) const;
  void fromLamps(Walk& walk) const;
  void fromLamp(Walk& walk, const Lamp::Arriving& from, const glm::vec3& radiance) const;
  bool chooseStep(Walk& walk, Step& step) const;
  void finish(Walk& walk, const Step& step) const;
  bool advance(Walk& walk, const Step& step, bool go_on) const;
  void addEnvironment(Walk& walk, const Step& step) const;
  float weight(float pdf, float other_pdf) const {
    const float ratio = other_pdf / pdf;
    return both_ ? 1.0f / (1.0f + ratio * ratio) : 1.0f;
  }
  bool visible(Walk& walk, const trace::Ray& ray) const;

  trace::Tracer tracer_;
  Surfaces surfaces_;
  std::shared_ptr<const EnvironmentSampler> environment_;
  Emitters emitters_;
  std::vector<Lamp> lamps_;
  Sources direct_, indirect_;
  int last_depth_ = 0;
  bool sample_lights_ = true, sample_lobes_ = true, both_ = true;
};

}  // namespace gloam::reference
