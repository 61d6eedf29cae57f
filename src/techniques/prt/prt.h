// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Run time of precomputed radiance transfer (Sloan, Kautz, Snyder 2002; PRT-1, PRT-2, PRT-4, PRT-8). README.md has
// the rest; baking is gloam/bake.h.
#pragma once

#include <optional>

#include "techniques/prt/prt_glossy.h"
#include "techniques/prt/prt_local.h"
#include "techniques/prt/prt_neighbourhood.h"
#include "techniques/prt/prt_transfer.h"
#include "techniques/prt/prt_volume.h"
#include "techniques/technique.h"

namespace gloam::prt {

const TechniqueInfo& info();

class Prt : public Technique {
 public:
  /// `chunk_bytes`: largest buffer of transfer; 0: what the device takes.
  explicit Prt(gpu::Device& device, std::size_t chunk_bytes = 0)
      : device_(device), chunk_bytes_(chunk_bytes), probe_tables_(device) {}
  /// Throws Error where no mesh of the scene carries transfer.
  frame::Lighting record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                         const Settings& settings) override;

 private:
  const TransferBuffers& transferFor(const frame::FrameInputs& inputs, const TransferOptions& options);
  const GlossyBuffers& glossyFor(const frame::FrameInputs& inputs, const GlossyOptions& options);
  const VolumeBuffers& volumesFor(const frame::FrameInputs& inputs, int order);
  const NeighbourhoodBuffers& neighbourhoodFor(const frame::FrameInputs& inputs, int order, bool on_host);
  gpu::BufferRef lightVerticesLocally(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                      const TransferBuffers& transfer, const Settings& settings);
  void addGloss(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Settings& settings,
                frame::Lighting& lighting);

  gpu::Device& device_;
  std::size_t chunk_bytes_;
  std::optional<TransferBuffers> transfer_;
  std::uint64_t layout_revision_ = 0;
  std::optional<GlossyBuffers> glossy_;
  std::uint64_t glossy_revision_ = 0;
  GlossFields gloss_fields_;  // of glossy_
  std::optional<LocalLight> local_;
  std::uint64_t local_revision_ = 0;
  frame::ProbeTables probe_tables_;
  std::optional<NeighbourhoodBuffers> neighbourhood_;
  std::uint64_t neighbourhood_revision_ = 0;
  std::optional<VolumeBuffers> volumes_;
  std::uint64_t volumes_revision_ = 0;
};

}  // namespace gloam::prt
