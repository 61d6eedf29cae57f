// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Twins of prt_vertices, prt_gloss_vertices, prt_neighbourhood_points and prt_neighbourhood_turn (.comp.glsl) for devices that are the
// host: a software driver loads lane by lane, the host's vector units read transfer as fast as memory gives it.
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

/// Glossy transfer as GlossyBuffers stores it, in memory.
struct GlossInMemory {
  const std::uint32_t* direct = nullptr;
  const std::uint32_t* indirect = nullptr;  ///< null: none
  std::span<const VertexBlock> blocks;
  int light_order = 5, field_order = 5;
  bool cheap = false, half_float = false;
};

/// The radiance at the chunk's vertices as halves, on all cores: fieldOrder^2 rows of 3 words (2 where there is no indirect), all rows of
/// a vertex side by side. `lights`: GlossyBuffers::lightRows().
void relightGloss(const GlossInMemory& chunk, std::span<const glm::vec3> lights, std::uint32_t* fields);

/// Rows of a neighbourhood's matrices as NeighbourhoodBuffers stores them, in memory.
struct GridInMemory {
  const float* visibility = nullptr;      ///< [coefficient][point]
  const std::uint32_t* thrown = nullptr;  ///< [row][pair of columns][3 words][point]; null: none
  std::uint32_t points = 0, first_row = 0, row_count = 0;
  int light_order = 5, field_order = 5;
};

/// The radiance at the grid's points as halves, on all cores: rows of it are those of the matrices, 3 words each (2 where nothing is
/// thrown), all rows of a point side by side. `lights`: L, then P row by row.
void multiplyGrid(const GridInMemory& grid, std::span<const glm::vec3> lights, std::uint32_t* fields);

/// Radiance as multiplyGrid() leaves it, and a rotation: (2l + 1)^2 numbers a band, row after row.
struct GridToTurn {
  const std::uint32_t* fields = nullptr;
  const float* rotation = nullptr;
  std::uint32_t* radiance = nullptr;  ///< as many words as `fields`
  std::uint32_t points = 0;
  std::uint32_t words_of_row = 3;
  int field_order = 5;
};
void turnGrid(const GridToTurn& grid);

}  // namespace gloam::prt
