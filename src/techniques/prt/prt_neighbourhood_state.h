// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a bake of a neighbourhood knows so far, and the file that keeps it across interruptions.
#pragma once

#include <gloam/neighbourhood.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>

#include "scene/scene_fingerprint.h"

namespace gloam::prt {

/// Points are worked on in blocks of this many; each block's result depends on nothing else.
inline constexpr std::size_t kNeighbourhoodBlock = 8;

/// Places in every cell at which visibility is traced as well: those of Gauss' rule with two along each axis, so that sums over
/// them are integrals over the cell of what the interpolation's weights are multiplied with.
inline constexpr std::size_t kCellSamples = 8;
inline glm::vec3 cellSample(std::size_t sample) {
  return 0.5f + (glm::vec3(sample & 1, sample >> 1 & 1, sample >> 2) - 0.5f) / std::sqrt(3.0f);
}
/// All samples of a cell together take as many directions as a point, but none so few that the grid would be fitted to their noise.
inline int sampleDirections(const NeighbourhoodOptions& options) {
  return std::min(options.directions, std::max(1024, options.directions / int(kCellSamples)));
}

struct NeighbourhoodState {
  NeighbourhoodTransfer grid;               ///< filled as blocks are done
  std::vector<std::uint8_t> inside;         ///< [point]: in the object
  std::vector<float> samples;               ///< [point, of the cell above it][sample][coefficient] of V
  std::vector<std::uint8_t> sample_inside;  ///< [point][sample]
  std::size_t blocks = 0;
  std::unique_ptr<std::atomic<std::uint8_t>[]> block_done;
  std::size_t blockBegin(std::size_t block) const { return block * kNeighbourhoodBlock; }
  std::size_t blockEnd(std::size_t block) const {
    return std::min(grid.points(), (block + 1) * kNeighbourhoodBlock);
  }
  /// Makes room beside the grid's own numbers; nothing is done yet.
  void begin();
  static std::size_t sampleBytes(const NeighbourhoodTransfer& grid) {  // a point, with what the fit takes
    return (kCellSamples + 3) * grid.visibilityCount() * sizeof(float) + kCellSamples;
  }
};

/// As writeCheckpoint and readCheckpoint (prt_bake_state.h).
void writeNeighbourhood(const std::filesystem::path& path, const Fingerprint& fingerprint,
                        const NeighbourhoodState& state);
bool readNeighbourhood(const std::filesystem::path& path, const Fingerprint& fingerprint,
                       NeighbourhoodState& state);

/// Tells how far the bake is, asks whether to stop, keeps the checkpoint fresh. Called by all threads.
class NeighbourhoodMeter {
 public:
  NeighbourhoodMeter(const Progress& progress, const std::filesystem::path& checkpoint,
                     const Fingerprint& fingerprint, const NeighbourhoodState& state);
  /// After each block; `rays` were traced in it. Returns false to stop.
  bool blockDone(std::size_t rays);
  /// Keeps what is done and throws Interrupted.
  [[noreturn]] void interrupt();
  /// Keeps all of it, where other work is still to come.
  void keepAll() {
    if (fresh_) save();
  }

 private:
  using Clock = std::chrono::steady_clock;
  double fractionDone() const;
  void report();
  void save();

  const Progress& progress_;
  const std::filesystem::path checkpoint_;
  const Fingerprint& fingerprint_;
  const NeighbourhoodState& state_;
  std::atomic<std::size_t> rays_{0};
  std::atomic<bool> stopped_{false};
  std::mutex mutex_;
  std::atomic<bool> fresh_{false};  ///< the file does not hold all of it yet
  Clock::time_point start_ = Clock::now(), last_report_{};
  Clock::duration save_interval_ = std::chrono::seconds(20);
};

}  // namespace gloam::prt
