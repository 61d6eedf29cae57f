// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a bake knows so far, and the file that keeps it across interruptions.
#pragma once

#include <gloam/bake.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "scene/scene_fingerprint.h"
#include "techniques/prt/prt_bake_directions.h"
#include "techniques/prt/prt_bake_points.h"
#include "techniques/prt/prt_glossy_state.h"

namespace gloam::prt {

/// Points are worked on in blocks of this many: the unit of threads, of progress and of checkpoints. Each block's result
/// depends on finished passes alone, so neither the order of blocks nor an interruption can show.
inline constexpr std::size_t kBlockSize = 16;

/// How a point stands to what is around it.
enum class Place : std::uint32_t {
  kOpen,
  kCramped,  ///< in a nook smaller than its mesh can show; takes the transfer of open neighbours, if there are any
  kBuried,  ///< inside something; takes the transfer of the nearest points that are not
};

/// Where a point's rays start, and whether it counts.
struct RaySite {
  glm::vec3 origin{0.0f};
  float blocked_cosine = 0.0f;  ///< integral of max(0, n.s) over blocked directions, 0 to pi
  Place place = Place::kOpen;
  float blocked_solid_angle =
      0.0f;                 ///< of directions above the horizon, 0 to 2 pi; kept where there are matrices
  std::uint32_t tiles = 0;  ///< of directions that it took
  float error = 0.0f;       ///< BakeOptions::error, as estimated
};

struct BakeState {
  std::size_t points = 0, blocks = 0;
  int coefficients = 0;
  std::size_t row = 0;           ///< floats a point in the three colour arrays below
  std::size_t bounce_tiles = 0;  ///< 0: no bounces
  int bounces = 0;

  int pass = 0;  ///< 0: shadow rays; b: bounce b; bounces + 1: done
  std::unique_ptr<std::atomic<std::uint8_t>[]> block_done;  ///< in this pass

  std::vector<float> direct;   ///< [point][coefficient]: DS; kRowPadding floats behind
  std::vector<RaySite> sites;  ///< [point]
  std::vector<std::uint16_t>
      blocked;  ///< [point][bounce tile]: directions of bounce passes that meet something
  std::vector<float> previous, next;  ///< [point] rows: M^{b-1} and M^b
  std::vector<float> indirect;        ///< [point] rows: sum of finished M^b
  /// Where light comes by way of mirrors: M^{b-2}, M^{b-3} ..., for as many mirrors as are followed; M^0 is `direct`.
  std::vector<std::vector<float>> earlier;
  /// [point]: bounce tiles that it uses, where each takes as many as it needs; found by the first bounce. Else empty.
  std::vector<std::uint32_t> bounce_used;
  GlossyState glossy;  ///< matrices, of some of the points

  std::size_t blocksDone() const;
  std::size_t blockBegin(std::size_t block) const { return block * kBlockSize; }
  std::size_t blockEnd(std::size_t block) const { return std::min(points, (block + 1) * kBlockSize); }
  /// To be called with all blocks done: M^b is added to the sum and becomes the source of the next pass.
  void finishPass();
};

BakeState makeBakeState(std::size_t points, const DirectionTables& tables, int bounces, bool mirrors = false);
/// What makeBakeState will take.
std::size_t bakeStateBytes(std::size_t points, const DirectionTables& tables, int bounces,
                           bool mirrors = false);

/// All of the scene and all options that change what a bake makes of it.
Fingerprint fingerprintOf(const Scene& scene, const BakeOptions& options);
/// The same with the points, which this version of the baker made, and the instruction set: of a bake under way.
Fingerprint fingerprintOf(const Scene& scene, const BakePoints& points, const BakeOptions& options);

/// Writes all finished blocks, beside the target and then renamed. May run while other blocks are worked on.
void writeCheckpoint(const std::filesystem::path& path, const Fingerprint& fingerprint,
                     const BakeState& state);
/// Fills the state from a file that was written for the same fingerprint; false where there is no such file. Throws Error
/// where the file is something else, belongs to another scene, other options or another version, or is damaged: it might
/// be dear to someone, so it is neither used nor overwritten.
bool readCheckpoint(const std::filesystem::path& path, const Fingerprint& fingerprint, BakeState& state);

}  // namespace gloam::prt
