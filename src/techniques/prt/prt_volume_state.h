// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a bake of volumes knows so far, and the file that keeps it across interruptions.
#pragma once

#include <gloam/volume.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include "scene/scene_fingerprint.h"

namespace gloam::prt {

/// Voxels that hold something are worked on in blocks of this many; each block's result depends on finished passes alone.
inline constexpr std::size_t kVolumeBlock = 64;

/// One volume. Rows are of voxels that hold something, [voxel][coefficient], padded to a multiple of four.
struct VolumeState {
  std::size_t filled = 0, row = 0;
  int passes = 0;                ///< orders of scattering, 1 at least
  int pass = 0;                  ///< 0: light that arrives; b: scattered b times more; `passes`: done
  std::vector<float> now, next;  ///< rows: K_(pass-1), which the pass reads, and what it writes
  Transfer transfer;             ///< of all voxels, with the passes that are finished
  double even = 0.0,
         even_last = 0;  ///< light under even light of all finished passes together, of the last alone
  std::size_t blocks = 0;
  std::unique_ptr<std::atomic<std::uint8_t>[]> block_done;  ///< in this pass

  void begin(const Volume& volume, std::size_t filled_voxels, const VolumeBakeOptions& options);
  bool begun() const { return passes > 0; }
  bool finished() const { return begun() && pass == passes; }
  std::size_t blockBegin(std::size_t block) const { return block * kVolumeBlock; }
  std::size_t blockEnd(std::size_t block) const { return std::min(filled, (block + 1) * kVolumeBlock); }
  std::size_t blocksDone() const;
  /// What was written becomes what is read; no block of the next pass is done.
  void nextPass();
};

/// Tells how far the bake of all volumes is, asks whether to stop, keeps the checkpoint fresh. Called by all threads.
class VolumeMeter {
 public:
  /// Takes up what the checkpoint holds, if it is there. `filled` counts each volume's voxels that hold something. Throws Error as
  /// readCheckpoint (prt_bake_state.h).
  VolumeMeter(const Scene& scene, const std::vector<const Volume*>& volumes,
              const std::vector<std::size_t>& filled, const VolumeBakeOptions& options,
              const Progress& progress, std::vector<VolumeState>& states);
  bool resumed() const { return resumed_; }
  /// After each block. False to stop.
  bool blockDone();
  /// Keeps what is done and throws Interrupted.
  [[noreturn]] void interrupt();
  /// Keeps all of it, where other work is still to come; else no file stays.
  void end();

 private:
  using Clock = std::chrono::steady_clock;
  bool read(const std::vector<const Volume*>& volumes, const std::vector<std::size_t>& filled);
  void save();
  double fractionDone() const;

  const VolumeBakeOptions& options_;
  const Progress& progress_;
  std::vector<VolumeState>& states_;
  Fingerprint fingerprint_;
  double work_ = 0.0;  ///< directions of all voxels in all passes
  bool resumed_ = false;
  std::atomic<bool> stopped_{false};
  std::mutex mutex_;
  Clock::time_point last_report_{};
  Clock::duration save_interval_ = std::chrono::seconds(20);
};

}  // namespace gloam::prt
