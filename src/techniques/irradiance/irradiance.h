// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Unshadowed irradiance of distant light from a few SH coefficients (Ramamoorthi, Hanrahan 2001). README.md
// has the rest.
#pragma once

#include "techniques/technique.h"

namespace gloam::irradiance {

const TechniqueInfo& info();

class Irradiance : public Technique {
 public:
  explicit Irradiance(gpu::Device&) {}
  frame::Lighting record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                         const Settings& settings) override;
};

}  // namespace gloam::irradiance
