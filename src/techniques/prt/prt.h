// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Run time of diffuse precomputed radiance transfer (Sloan, Kautz, Snyder 2002; PRT-1, PRT-4). README.md has
// the rest; baking is prt_bake.h.
#pragma once

#include <optional>

#include "techniques/prt/prt_transfer.h"
#include "techniques/technique.h"

namespace gloam::prt {

const TechniqueInfo& info();

class Prt : public Technique {
 public:
  /// `chunk_bytes`: largest buffer of transfer; 0: what the device takes.
  explicit Prt(gpu::Device& device, std::size_t chunk_bytes = 0)
      : device_(device), chunk_bytes_(chunk_bytes) {}
  /// Throws Error where no mesh of the scene carries transfer.
  frame::Lighting record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                         const Settings& settings) override;

 private:
  const TransferBuffers& transferFor(const frame::FrameInputs& inputs, const TransferOptions& options);

  gpu::Device& device_;
  std::size_t chunk_bytes_;
  std::optional<TransferBuffers> transfer_;
  std::uint64_t layout_revision_ = 0;
};

}  // namespace gloam::prt
