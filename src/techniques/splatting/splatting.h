// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light of lamps that comes by way of one other surface, splatted into a buffer of many resolutions (Nichols, Wyman 2009).
// README.md has the rest.
#pragma once

#include "techniques/splatting/splatting_host.h"
#include "techniques/technique.h"
#include "visibility/host_world.h"

namespace gloam::splatting {

const TechniqueInfo& info();

class Splatting : public Technique {
 public:
  explicit Splatting(gpu::Device&) {}
  frame::Lighting record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                         const Settings& settings) override;

 private:
  visibility::HostWorld world_;
  HostSplatting host_;
};

}  // namespace gloam::splatting
