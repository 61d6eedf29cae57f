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
#include "trace/tracer.h"

namespace gloam::prt {

/// Shadow rays from one point. blocked[tile] gets a bit for every direction above the horizon of `normal` that meets
/// something; tiles wholly below are not traced and get 0. Returns the number of rays.
std::size_t traceBlocked(const trace::Tracer& tracer, const DirectionTables& tables, const glm::vec3& origin,
                         const glm::vec3& normal, std::uint16_t* blocked);

/// The packets that traceBlocked would trace, without tracing: tiles and the bits of directions above the horizon. For the
/// benchmark. Returns how many tiles; both arrays hold tables.tiles elements.
int tilesAbove(const DirectionTables& tables, const glm::vec3& normal, std::int32_t* tiles,
               std::uint16_t* above);

inline constexpr int kProjectedTogether = 4;

/// Sums y_i(s) max(0, n.s) over the blocked directions of four points at once, so that a tile's basis functions are
/// fetched once for all. blocked[p] as traceBlocked leaves it; sums[p] gets `coefficients` values.
void projectBlocked(const DirectionTables& tables, const glm::vec3 normals[kProjectedTogether],
                    const std::uint16_t* const blocked[kProjectedTogether],
                    float* const sums[kProjectedTogether]);

/// A hit that sends transfer on: where it stands between three points, and its weight per colour.
struct GatheredHit {
  std::uint32_t point[3];
  float share[3];   ///< barycentric
  float weight[3];  ///< red, green, blue
};

/// Rows of colour transfer: [point][red, green, blue][coefficients rounded up to 4], with kRowPadding floats behind the
/// last row that may be read.
inline constexpr std::size_t kRowPadding = 16;
inline std::size_t rowStride(int coefficients) {
  return (std::size_t(coefficients) + 3) / 4 * 4;
}

/// Writes to row (3 * rowStride floats) the sum over hits of weight * (share-weighted mean of three rows of `transfer`).
void gatherHits(const float* transfer, int coefficients, std::span<const GatheredHit> hits, float* row);

/// Name of the instruction set that is used.
const char* kernelTarget();

}  // namespace gloam::prt
