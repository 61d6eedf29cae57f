// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Which virtual lights subsplats see (row MS-8): rays on the host between two passes.
#pragma once

#include <memory>

#include "techniques/splatting/splatting_levels.h"
#include "visibility/visibility_shared.h"

namespace gloam::splatting {

/// What the host passes of one frame share: subsplats as ends of rays.
struct TracedPlaces {
  bool loaded = false;
  std::size_t lights = 0;
  std::vector<visibility::SightPoint> points;  ///< as in the list
};

struct VisibilityChunk {
  int chunk = 0;        ///< of all lights
  gpu::BufferRef list;  ///< of subsplats that ask
  gpu::BufferRef
      visible;  ///< a bit for each light of the chunk: a word an entry of the list, then their second words
};

/// Adds "splatting.visibility", which fills chunk.visible.
void recordVisibility(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Subsplats& subsplats,
                      const LightSets& lights, visibility::HostWorld& world, const VisibilityChunk& chunk,
                      std::shared_ptr<TracedPlaces> shared);

}  // namespace gloam::splatting
