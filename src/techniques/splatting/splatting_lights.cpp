// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Beyond Nichols and Wyman 2009, who name it as future work (section 6): each subsplat takes its own set of virtual lights. Sets are
// made as in lightcuts (Walter et al. 2005), in whole levels of the tree.
#include "techniques/splatting/splatting_lights.h"

#include <bit>

#include "shaders/splatting_shaders.h"

namespace gloam::splatting {

LightSets recordLightSets(gpu::FrameGraph& graph, const vpls::Vpls& vpls) {
  constexpr std::uint32_t kChunk = vpls::kVplChunk;
  LightSets lights;
  lights.count = vpls.count;
  std::uint32_t total = 0;
  for (std::uint32_t rows = vpls.capacity;; rows = (rows + 3) / 4) {
    const std::uint32_t whole = (rows + kChunk - 1) / kChunk * kChunk;
    lights.sets.push_back({total, whole, int(total / kChunk)});
    total += whole;
    if (whole <= kChunk || lights.sets.size() == std::size_t(kMostSets)) break;
  }
  lights.rows = graph.create("splatting.lights", gpu::BufferDesc{.bytes = total * sizeof(SplatLight)});
  graph.clear("splatting.lights", lights.rows);
  struct SortPush {
    std::uint32_t capacity, network;
  };
  const std::uint32_t blocks = (vpls.capacity + kSorted - 1) / kSorted;
  graph.compute("splatting.sort", splatting_sort_spv)
      .read("rows", vpls.rows)
      .write("lights", lights.rows)
      .read("vpl_count", vpls.count)
      .push(SortPush{vpls.capacity, std::min(std::bit_ceil(vpls.capacity), std::uint32_t(kSorted))})
      .dispatch(blocks);
  struct MergePush {
    std::uint32_t from, from_count, to, to_count;
  };
  for (std::size_t s = 1; s < lights.sets.size(); ++s) {
    const LightSet &from = lights.sets[s - 1], &to = lights.sets[s];
    const std::uint32_t merged = (from.rows + 3) / 4;
    graph.compute("splatting.merge", splatting_merge_spv)
        .readWrite("lights", lights.rows)
        .push(MergePush{from.first, from.rows, to.first, merged})
        .dispatchOver(int(merged));
  }
  return lights;
}

}  // namespace gloam::splatting
