// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The inner loops of a bake, vectorised for whatever the machine has (Highway, chosen at run time). Results do not depend
// on threads; they do depend, in the last bits, on the instruction set.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "techniques/prt/prt_bake_directions.h"
#include "techniques/prt/prt_bake_hits.h"
#include "trace/tracer.h"

namespace gloam::prt {

/// Shadow rays from one point, along one batch of directions, each turned by `turn`. blocked[tile], for the tiles of the batch,
/// gets a bit for every direction that meets something and is above the horizon of `normal`, which is in the axes of the set;
/// tiles wholly below are not traced and get 0. Returns the number of rays.
std::size_t traceBlocked(const trace::Tracer& tracer, const DirectionTables& tables,
                         const DirectionBatch& batch, const glm::vec3& origin, const glm::vec3& normal,
                         const glm::mat3& turn, std::uint16_t* blocked);

/// The packets that traceBlocked would trace of the first batch, without tracing: tiles and the bits of directions above
/// the horizon. For the benchmark. Returns how many tiles; both arrays hold as many elements as the batch has tiles.
int tilesAbove(const DirectionTables& tables, const glm::vec3& normal, std::int32_t* tiles,
               std::uint16_t* above);

inline constexpr int kProjectedTogether = 4;

/// Sums y_i(s) max(0, n.s) over the blocked directions of a batch, of four points at once, so that a tile's basis functions
/// are fetched once for all. blocked[p] as traceBlocked leaves it; sums[p] gets `coefficients` values.
void projectBlocked(const DirectionTables& tables, const DirectionBatch& batch,
                    const glm::vec3 normals[kProjectedTogether],
                    const std::uint16_t* const blocked[kProjectedTogether],
                    float* const sums[kProjectedTogether]);

/// Rows of colour transfer: [point][red, green, blue][coefficients rounded up to 4], with kRowPadding floats behind the
/// last row that may be read.
inline constexpr std::size_t kRowPadding = 16;
inline std::size_t rowStride(int coefficients) {
  return (std::size_t(coefficients) + 3) / 4 * 4;
}

/// Transfer that hits send on: rows of colour as above, or grey ones of `coefficients` floats each, likewise padded. Null: none.
struct GatherSource {
  const float* rows = nullptr;
  bool grey = false;
};
/// By the number of mirrors on the way: transfer of as many passes before the last.
struct GatherSources {
  GatherSource by_mirrors[kMostMirrors + 1];
};

/// Adds to row (3 * rowStride floats) scale * the sum over hits of weight * (mean of its three points' rows by
/// their shares).
void gatherHits(const GatherSources& sources, int coefficients, std::span<const GatheredHit> hits,
                float scale, float* row);

/// Name of the instruction set that is used.
const char* kernelTarget();

}  // namespace gloam::prt
