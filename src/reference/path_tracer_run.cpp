// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A whole picture: how far to go, the checkpoint on the way.
#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "reference/path_tracer_state.h"

namespace gloam {
namespace {

using reference::kMaxSamples;
using Clock = std::chrono::steady_clock;

void checkGoal(const ReferenceGoal& goal) {
  if (goal.samples < 1 || goal.samples > kMaxSamples) {
    throw Error("reference", fmt::format("samples is {}; expected 1 to {}", goal.samples, kMaxSamples));
  }
  if (!(goal.noise >= 0.0f) || std::isinf(goal.noise)) {
    throw Error("reference",
                fmt::format("noise is {}; expected a positive number, or 0 for none", goal.noise));
  }
}

/// One picture on its way to its goal.
class Run {
 public:
  Run(PathTracer& tracer, const ReferenceOptions& options, const ReferenceGoal& goal,
      const Progress& progress)
      : tracer_(tracer),
        goal_(goal),
        progress_(progress),
        round_(options.supersample * options.supersample),
        expected_(goal.samples) {}

  void takeUp() {
    std::error_code none;
    if (goal_.checkpoint.empty() || !std::filesystem::exists(goal_.checkpoint, none)) return;
    tracer_.load(goal_.checkpoint);
    if (tracer_.samples() <= goal_.samples) return;
    throw Error(
        goal_.checkpoint.string(),
        fmt::format("holds {} samples a pixel, more than the {} that are asked for; delete it or name "
                    "another checkpoint",
                    tracer_.samples(), goal_.samples));
  }

  // Noise is looked at after numbers of samples that do not depend on interruptions: the same call stops at the same
  // number.
  void finish() {
    const int started = tracer_.mostSamples();  // noise was looked at before any pixel went on
    for (int check = firstCheck(); tracer_.samples() < goal_.samples; check = nextCheck(check)) {
      if (check < started) continue;
      refineTo(goal_.noise > 0.0f ? std::min(check, goal_.samples) : goal_.samples);
      if (goal_.noise > 0.0f && quietEnough()) break;
    }
  }

  void removeCheckpoint() const {
    std::error_code ignored;
    if (!goal_.checkpoint.empty()) std::filesystem::remove(goal_.checkpoint, ignored);
  }

 private:
  // A variance of few samples is itself too uncertain to stop by.
  int firstCheck() const { return roundedUp(16); }
  int nextCheck(int check) const { return roundedUp(check + check / 4); }
  int roundedUp(int samples) const { return std::min((samples + round_ - 1) / round_ * round_, kMaxSamples); }

  bool quietEnough() {
    noise_ = tracer_.noise();
    if (noise_ <= double(goal_.noise)) return true;
    if (std::isfinite(noise_)) {
      const double ratio = noise_ / double(goal_.noise);
      expected_ = std::clamp(double(tracer_.samples()) * ratio * ratio, 1.0, double(goal_.samples));
    }
    return false;
  }

  // Stops of our own, for the checkpoint, look like others to the tracer.
  void refineTo(int until) {
    while (tracer_.samples() < until) {
      const int from = tracer_.samples(), count = until - from;
      bool stopped = false;
      Progress watched;
      watched.should_stop = [&] {
        stopped = progress_.stopRequested();
        return stopped || (!goal_.checkpoint.empty() && Clock::now() >= next_save_);
      };
      if (progress_.update) {
        watched.update = [&](double fraction, const std::string&) { tell(from + fraction * count); };
      }
      try {
        tracer_.refine(count, watched);
      } catch (const Interrupted&) {
        save();
        if (stopped) interrupt();
      }
    }
  }

  void tell(double samples) const {
    std::string what = fmt::format("reference: {:.0f} of {} samples", samples, goal_.samples);
    if (goal_.noise > 0.0f) {
      what += std::isfinite(noise_)
                  ? fmt::format(", noise {:.2g} % of {:.2g} %", 100.0 * noise_, 100.0 * double(goal_.noise))
                  : fmt::format(", until noise is {:.2g} %", 100.0 * double(goal_.noise));
    }
    progress_.report(std::min(samples / expected_, 1.0), what);
  }

  void save() {
    if (goal_.checkpoint.empty()) return;
    const Clock::time_point begin = Clock::now();
    // A large picture's file takes seconds: whoever pressed Ctrl-C sees what they wait for.
    progress_.report(std::min(tracer_.samples() / expected_, 1.0), "reference: keeping the samples");
    tracer_.save(goal_.checkpoint);
    // Large pictures are kept less often: at most a tenth of the time goes into it.
    next_save_ = Clock::now() + std::max<Clock::duration>(kSaveInterval, 10 * (Clock::now() - begin));
  }

  [[noreturn]] void interrupt() const {
    if (goal_.checkpoint.empty()) {
      throw Interrupted(
          fmt::format("reference stopped after {} of {} samples; without a checkpoint nothing is kept",
                      tracer_.samples(), goal_.samples));
    }
    throw Interrupted(fmt::format(
        "reference stopped after {} of {} samples; {} keeps them, the same command goes on from there",
        tracer_.samples(), goal_.samples, goal_.checkpoint.string()));
  }

  static constexpr auto kSaveInterval = std::chrono::seconds(20);

  PathTracer& tracer_;
  const ReferenceGoal& goal_;
  const Progress& progress_;
  const int round_;
  double noise_ = INFINITY, expected_;
  Clock::time_point next_save_ = Clock::now() + kSaveInterval;
};

}  // namespace

LayeredImage renderReference(const Scene& scene, const PosedScene& posed, const PosedCamera& camera,
                             const Environment& environment, const ReferenceOptions& options,
                             const ReferenceGoal& goal, bool parts, const Progress& progress,
                             ReferenceReport* report) {
  checkGoal(goal);
  PathTracer tracer(scene, posed, camera, environment, options, progress);
  Run run(tracer, options, goal, progress);
  run.takeUp();
  run.finish();
  LayeredImage picture = parts ? tracer.imageWithParts() : tracer.image();
  if (report) *report = tracer.report();
  run.removeCheckpoint();
  return picture;
}

}  // namespace gloam
