// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Tells how far a bake is, asks whether to stop, and keeps the checkpoint fresh. Called by all threads.
#pragma once

#include <chrono>
#include <mutex>

#include "techniques/prt/prt_bake_state.h"

namespace gloam::prt {

class BakeMeter {
 public:
  using Clock = std::chrono::steady_clock;

  /// `pass_work[p]` is what pass p costs, in any unit; the checkpoint is kept where options name one.
  BakeMeter(const Progress& progress, const BakeOptions& options, const Fingerprint& fingerprint,
            BakeState& state, std::vector<double> pass_work);

  /// At the start of each pass. Work that a checkpoint brought counts as done, not as speed.
  void beginPass();
  /// After each block of the pass; `rays` were traced in it. Returns false to stop. One thread at a time looks after
  /// listener and file, the others go on.
  bool blockDone(std::size_t rays);
  /// Keeps what is done and throws Interrupted.
  [[noreturn]] void interrupt();
  /// After the last pass: all of it is kept where other work is still to come.
  void lastPassDone() {
    if (keep_ && fresh_) save();
  }

 private:
  double fractionDone() const;
  void report(Clock::time_point now);
  void save();

  const Progress& progress_;
  const std::filesystem::path checkpoint_;
  const bool keep_;
  const Fingerprint& fingerprint_;
  BakeState& state_;
  const std::vector<double> pass_work_;
  double total_work_ = 0.0, work_at_start_ = -1.0;
  std::atomic<std::size_t> rays_{0}, blocks_{0};
  std::atomic<bool> stopped_{false};
  std::atomic<bool> fresh_{false};  ///< the file does not hold all of it yet
  std::mutex mutex_;
  Clock::time_point start_, pass_start_, last_report_;
  Clock::duration save_interval_ = std::chrono::seconds(20);
};

}  // namespace gloam::prt
