// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Which virtual lights subsplats see (row MS-8): rays on the host between two passes.
#pragma once

#include <memory>

#include "techniques/splatting/splatting_levels.h"

namespace gloam::splatting {

/// What the host passes of one level share: its subsplats as ends of rays.
struct LevelPlaces {
  bool loaded = false;
  std::size_t lights = 0;
  std::vector<visibility::Place> places;
};

struct VisibilityChunk {
  int level = 0;
  std::uint32_t chunk = 0;
  gpu::BufferRef visible;  ///< a bit for each light of the chunk, eight bytes a leaf of the level
};

/// Adds "splatting.visibility", which fills chunk.visible.
void recordVisibility(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Subsplats& subsplats,
                      const vpls::Vpls& vpls, visibility::HostRays& rays, const VisibilityChunk& chunk,
                      std::shared_ptr<LevelPlaces> shared);

}  // namespace gloam::splatting
