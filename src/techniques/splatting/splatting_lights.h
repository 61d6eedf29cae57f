// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The virtual lights in several sets, each with a quarter of the lights of the one before, merged four by four: where clusters are
// small against their distance, a subsplat takes a coarse set (row MS-9).
#pragma once

#include "techniques/splatting/splatting_shared.h"
#include "vpls/vpls.h"

namespace gloam::splatting {

struct LightSet {
  std::uint32_t first = 0;  ///< row, a multiple of kVplChunk
  std::uint32_t rows = 0;   ///< the same
  int first_chunk = 0;      ///< among those of all sets

  int chunks() const { return int(rows) / vpls::kVplChunk; }
};

struct LightSets {
  gpu::BufferRef rows;         ///< SplatLight
  gpu::BufferRef count;        ///< of lights that shine, in the first set
  std::vector<LightSet> sets;  ///< all lights first; the last one is a single chunk

  int chunks() const { return sets.back().first_chunk + sets.back().chunks(); }
  gpu::BufferRef chunk(std::size_t set, int index) const {
    const std::size_t bytes = vpls::kVplChunk * sizeof(SplatLight);
    return rows.slice((sets[set].first / vpls::kVplChunk + std::size_t(index)) * bytes, bytes);
  }
};

/// Passes "splatting.sort" and "splatting.merge".
LightSets recordLightSets(gpu::FrameGraph& graph, const vpls::Vpls& vpls);

}  // namespace gloam::splatting
