// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Image-space proxies (Sloan, Govindaraju, Nowrouzezahrai, Snyder 2007; PX-1 to PX-9): everything may move; things cast soft
// shadows and colour by a few spheres each. README.md has the rest.
#pragma once

#include <optional>

#include "techniques/proxies/proxies_coverage.h"
#include "techniques/technique.h"

namespace gloam::proxies {

const TechniqueInfo& info();

class Proxies : public Technique {
 public:
  explicit Proxies(gpu::Device& device);
  frame::Lighting record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                         const Settings& settings) override;

 private:
  /// What the light asks for, kept as long as it stays the same.
  const Reach& reachFor(const ProxyLight& light);

  gpu::Buffer log_table_, alone_table_, operator_table_;
  std::optional<ProxyLight> light_;
  Reach reach_;
};

}  // namespace gloam::proxies
