// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_bake_meter.h"

#include <fmt/format.h>

#include <numeric>

#include "scene/checkpoint_file.h"

namespace gloam::prt {
namespace {

constexpr auto kReportInterval = std::chrono::milliseconds(100);

double seconds(BakeMeter::Clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

std::string duration(double s) {
  if (s < 90.0) return fmt::format("{:.0f} s", s);
  if (s < 5400.0) return fmt::format("{:.0f} min", s / 60.0);
  return fmt::format("{:.1f} h", s / 3600.0);
}

}  // namespace

BakeMeter::BakeMeter(const Progress& progress, const BakeOptions& options, const Fingerprint& fingerprint,
                     BakeState& state, std::vector<double> pass_work)
    : progress_(progress),
      checkpoint_(options.checkpoint),
      keep_(options.apart || options.keep_checkpoint),
      fingerprint_(fingerprint),
      state_(state),
      pass_work_(std::move(pass_work)),
      total_work_(std::accumulate(pass_work_.begin(), pass_work_.end(), 0.0)),
      start_(Clock::now()) {}

void BakeMeter::beginPass() {
  pass_start_ = Clock::now();
  rays_ = 0;
  blocks_ = state_.blocksDone();
  if (work_at_start_ < 0.0) work_at_start_ = fractionDone();
  report(pass_start_);
}

double BakeMeter::fractionDone() const {
  double done = 0.0;
  for (int p = 0; p < state_.pass; ++p) done += pass_work_[std::size_t(p)];
  done += pass_work_[std::size_t(state_.pass)] * double(blocks_.load()) / double(state_.blocks);
  return done / total_work_;
}

void BakeMeter::report(Clock::time_point now) {
  last_report_ = now;
  if (!progress_.update) return;
  const double fraction = fractionDone(), elapsed = seconds(now - start_), here = fraction - work_at_start_;
  const double mrays = double(rays_.load()) * 1.0e-6, pass_elapsed = seconds(now - pass_start_);
  std::string what = state_.pass == 0 ? std::string("bake: shadow rays")
                                      : fmt::format("bake: bounce {} of {}", state_.pass, state_.bounces);
  if (mrays > 0.0)
    what += fmt::format(", {:.1f} Mrays, {:.1f} Mrays/s", mrays, mrays / std::max(1e-3, pass_elapsed));
  if (here > 0.0 && elapsed > 0.5) what += ", " + duration(elapsed * (1.0 - fraction) / here) + " left";
  progress_.report(fraction, what);
}

void BakeMeter::save() {
  if (checkpoint_.empty()) return;
  const auto begin = Clock::now();
  writeCheckpoint(checkpoint_, fingerprint_, state_);
  // Large states are written less often: at most a tenth of the time goes into it.
  save_interval_ = std::max<Clock::duration>(std::chrono::seconds(20), 10 * (Clock::now() - begin));
}

bool BakeMeter::blockDone(std::size_t rays) {
  rays_ += rays;
  ++blocks_;
  fresh_ = true;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (lock && !stopped_) {
    const auto now = Clock::now();
    if (progress_.stopRequested()) stopped_ = true;
    if (!stopped_ && now - last_report_ > kReportInterval) report(now);
    if (!stopped_ && now - CheckpointWriter::lastCommit() > save_interval_) save();
  }
  return !stopped_;
}

void BakeMeter::interrupt() {
  save();
  const double percent = 100.0 * fractionDone();
  if (checkpoint_.empty()) {
    throw Interrupted(fmt::format("bake stopped at {:.0f} %; without a checkpoint nothing is kept", percent));
  }
  throw Interrupted(
      fmt::format("bake stopped at {:.0f} %; {} keeps the work, the same command goes on from there", percent,
                  checkpoint_.string()));
}

}  // namespace gloam::prt
