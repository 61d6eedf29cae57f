// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Light of all kinds by virtual lights, a set of them a pixel in turn, averaged as directional radiance before it is shaded
// (Segovia, Wald 2008). README.md has the rest.
#pragma once

#include "techniques/radiance_filter/radiance_filter_host.h"
#include "techniques/technique.h"
#include "visibility/visibility.h"
#include "vpls/walks.h"

namespace gloam::radiance_filter {

const TechniqueInfo& info();

class RadianceFilter : public Technique {
 public:
  explicit RadianceFilter(gpu::Device& device) : visibility_(device) {}
  /// Throws Error where the picture's fields are larger than a buffer of the device.
  frame::Lighting record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                         const Settings& settings) override;

 private:
  /// Says once a scene that materials are sharper than three bands show.
  void remarkSharpMaterials(const frame::FrameInputs& inputs, bool beams);

  visibility::Visibility visibility_;
  vpls::Walker walker_;
  HostSurfaces surfaces_{0, 0};
  std::uint64_t looked_at_ = 0;  ///< layout of the scene whose materials were looked at
};

}  // namespace gloam::radiance_filter
