// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The twin of prt_vertices.comp.glsl for devices that are the host: a software driver loads lane by lane, the host's vector
// units read transfer as fast as memory gives it.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "techniques/prt/prt_shared.h"

namespace gloam::prt {

/// Transfer as TransferChunk stores it, in memory.
struct ChunkInMemory {
  const std::uint32_t* direct = nullptr;
  const std::uint32_t* indirect = nullptr;  ///< null: none
  std::span<const VertexBlock> blocks;
  int coefficients = 25;  ///< of each vertex; at most 36
  bool half_float = false;
};

/// Irradiance of the chunk's vertices, on all cores. `lights`: coefficients of each instance, as VertexBlock::light counts them;
/// `first_peak` of them on, where `in_parts`, the sharpest peaks that the others lack. What is not finite stays so.
void relight(const ChunkInMemory& chunk, std::span<const glm::vec3> lights, std::uint32_t first_peak,
             bool in_parts, std::span<VertexLight> vertex_light);

}  // namespace gloam::prt
