// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Spherical lights (Guerrero, Jeschke, Wimmer 2008; SL-1 to SL-10): everything may move; things stand in each other's light and
// colour, by spheres whose light is shadowed where it arrives and where it goes. README.md has the rest.
#pragma once

#include "techniques/spherical_lights/spherical_lights_step.h"
#include "techniques/spherical_lights/spherical_lights_tables.h"
#include "techniques/technique.h"

namespace gloam::spherical_lights {

const TechniqueInfo& info();

class SphericalLights : public Technique {
 public:
  explicit SphericalLights(gpu::Device& device);
  frame::Lighting record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                         const Settings& settings) override;

 private:
  Sending recordSending(const Step& step);
  LightRows lightRows(const sh::ShRgb& light, const Settings& settings) const;

  gpu::Buffer cells_;
  Fit area_fit_, solid_angle_fit_;
};

}  // namespace gloam::spherical_lights
