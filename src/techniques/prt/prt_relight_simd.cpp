// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// E_p = M_p . L' of Sloan, Kautz, Snyder 2002, a vertex a lane. A block is read once, from its first byte to its last; sums of
// 16 or more vertices stay in registers meanwhile. Halves are widened in pairs as they stand in their words, each of a pair
// times its own coefficient, and pairs are added at the end.
#include "math/simd_targets.h"
// Highway compiles this file once an instruction set; the order of its headers matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/prt/prt_relight_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

#include "techniques/prt/prt_relight_kernel.h"
#include "techniques/prt/prt_sums_simd.h"

HWY_BEFORE_NAMESPACE();
namespace gloam::prt {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <bool colored>
HWY_INLINE void add(const ChunkInMemory& chunk, std::uint32_t block, const Light& light, Sums& sums) {
  const auto n = static_cast<std::size_t>(chunk.coefficients);
  const std::size_t values = colored ? 3 * n : n;
  const std::uint32_t* words = (colored ? chunk.indirect : chunk.direct) +
                               block * (chunk.half_float ? (values + 1) / 2 : values) * kBlockVertices;
  if (chunk.half_float)
    addHalves<colored>(words, n, light, sums);
  else
    addFloats<colored>(reinterpret_cast<const float*>(words), n, light.flat, sums);
}

/// `both`: what is there already is held to 0 or more and added to, held alike (bothParts of prt_ringing.glsl).
HWY_INLINE void put(const Sums& direct, const Sums& indirect, bool has_indirect, bool both,
                    std::span<VertexLight> to) {
  for (std::size_t v = 0; v < to.size(); ++v) {
    const glm::vec3 d(direct.of[0][v], direct.of[1][v], direct.of[2][v]);
    glm::vec3 i(0.0f);
    if (has_indirect) i = {indirect.of[0][v], indirect.of[1][v], indirect.of[2][v]};
    if (both)
      to[v] = {glm::max(to[v].direct, glm::vec3(0.0f)) + glm::max(d, glm::vec3(0.0f)),
               glm::max(to[v].indirect, glm::vec3(0.0f)) + glm::max(i, glm::vec3(0.0f))};
    else
      to[v] = {d, i};
  }
}

void relightBlocks(const ChunkInMemory& chunk, std::size_t begin, std::size_t end,
                   std::span<const glm::vec3> lights, std::uint32_t first_peak, bool in_parts,
                   std::span<VertexLight> vertex_light) {
  const auto n = static_cast<std::size_t>(chunk.coefficients);
  const bool has_indirect = chunk.indirect != nullptr;
  Light light, peak;
  Sums direct, indirect;
  for (std::size_t at = begin; at < end; ++at) {
    const VertexBlock& block = chunk.blocks[at];
    const std::span<VertexLight> to = vertex_light.subspan(block.output_, block.count);
    light.set(lights, block.light, n);
    add<false>(chunk, block.transfer, light, direct);
    if (has_indirect) add<true>(chunk, block.transfer, light, indirect);
    put(direct, indirect, has_indirect, false, to);
    if (!in_parts) continue;
    peak.set(lights, first_peak + block.light, n);
    add<false>(chunk, block.transfer, peak, direct);
    if (has_indirect) add<true>(chunk, block.transfer, peak, indirect);
    put(direct, indirect, has_indirect, true, to);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gloam::prt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gloam::prt {

HWY_EXPORT(relightBlocks);

void relight(const ChunkInMemory& chunk, std::span<const glm::vec3> lights, std::uint32_t first_peak,
             bool in_parts, std::span<VertexLight> vertex_light) {
  constexpr std::size_t kTogether = 64;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunk.blocks.size(), kTogether),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      HWY_DYNAMIC_DISPATCH(relightBlocks)
                      (chunk, range.begin(), range.end(), lights, first_peak, in_parts, vertex_light);
                    });
}

}  // namespace gloam::prt
#endif
