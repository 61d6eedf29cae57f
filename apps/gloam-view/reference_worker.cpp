// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference_worker.h"

#include <reference/reference_file.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "surface_mask.h"

namespace gloam::view {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kPublishSeconds = 0.7;
constexpr const char* kPlace = "reference";
const std::vector<std::string> kRgb = {"R", "G", "B"};

/// Infinite where it is not known yet.
double noiseOf(const LayeredImage& picture) {
  const auto variance = picture.attributes.find(reference::kVariance);
  if (variance == picture.attributes.end()) return std::numeric_limits<double>::infinity();
  return cli::relativeNoise(std::stod(variance->second), picture.image("", kRgb, kPlace),
                            cli::surfaceMask(picture, kPlace))
      .value_or(0.0);
}

}  // namespace

ReferenceWorker::ReferenceWorker(std::function<void()> wake)
    : wake_(std::move(wake)), thread_([this] { run(); }) {}

ReferenceWorker::~ReferenceWorker() {
  quit_ = stop_ = true;
  { const std::lock_guard lock(mutex_); }
  changed_.notify_all();
  thread_.join();
}

void ReferenceWorker::start(const ViewState& state, std::shared_ptr<const Drawn> drawn, const Coverage& light,
                            int bounces, int max_samples) {
  {
    const std::lock_guard lock(mutex_);
    next_ = {state, drawn->camera, drawn->width, drawn->height, light, bounces, max_samples};
    compared_ = std::move(drawn);
    published_.reset();
    finished_.reset();
    measure_again_ = false;
    stop_ = true;
  }
  changed_.notify_all();
}

void ReferenceWorker::compare(std::shared_ptr<const Drawn> drawn) {
  {
    const std::lock_guard lock(mutex_);
    compared_ = std::move(drawn);
    measure_again_ = true;
  }
  changed_.notify_all();
}

void ReferenceWorker::stop() {
  const std::lock_guard lock(mutex_);
  next_.reset();
  finished_.reset();
  published_.reset();
  measure_again_ = false;
  stop_ = true;
}

std::shared_ptr<const ReferenceView> ReferenceWorker::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(finished_, nullptr);
}

bool ReferenceWorker::superseded() const {
  return quit_ || stop_;
}

void ReferenceWorker::run() {
  while (true) {
    std::optional<Request> request;
    std::shared_ptr<const ReferenceView> again;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return quit_ || next_.has_value() || (measure_again_ && published_); });
      if (quit_) return;
      request = std::exchange(next_, std::nullopt);
      if (request) stop_ = false;
      if (!request) again = published_;
    }
    try {
      again ? publish(*again) : trace(*request);
    } catch (const Interrupted&) {
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      if (superseded()) continue;
      auto view = std::make_shared<ReferenceView>();
      view->problem = error.what();
      finished_ = std::move(view);
    }
    wake_();
  }
}

void ReferenceWorker::trace(const Request& request) {
  const ViewState& state = request.state;
  ReferenceOptions options;
  options.width = request.width;
  options.height = request.height;
  options.light = request.light;
  options.bounces = request.bounces;
  options.background = state.background;
  options.threads = std::max(1, int(std::thread::hardware_concurrency()) - 1);  // one for the window
  Progress progress;
  progress.should_stop = [this] { return superseded(); };
  const PosedScene posed = cli::poseMoved(state.scene->scene, state.moves, state.time_s);
  PathTracer tracer(state.scene->scene, posed, request.camera, paintedLight(state), options, progress);
  const Clock::time_point started = Clock::now();
  Clock::time_point shown = started;
  while (tracer.samples() < request.max_samples) {
    tracer.refine(tracer.samples() < 4 ? 1 : 2, progress);
    const Clock::time_point now = Clock::now();
    const bool first = tracer.samples() <= 2;
    const bool last = tracer.samples() >= request.max_samples;
    if (!first && !last && std::chrono::duration<double>(now - shown).count() < kPublishSeconds) continue;
    ReferenceView view;
    view.layers = std::make_shared<const LayeredImage>(tracer.image());
    view.samples = tracer.samples();
    view.noise = noiseOf(*view.layers);
    view.seconds = std::chrono::duration<double>(now - started).count();
    publish(std::move(view));
    shown = Clock::now();
  }
}

/// Measured against the picture that is the newest now.
void ReferenceWorker::publish(ReferenceView view) {
  std::shared_ptr<const Drawn> drawn;
  {
    const std::lock_guard lock(mutex_);
    drawn = compared_;
    measure_again_ = false;
  }
  view.error.reset();
  if (drawn && drawn->left.layers && drawn->width == view.layers->width &&
      drawn->height == view.layers->height) {
    // As `gloam compare` measures: on surfaces, as light that is seen itself is the same in both.
    const Image ours = drawn->left.layers->image("", kRgb, kPlace),
                truth = view.layers->image("", kRgb, kPlace);
    const Image mask = cli::surfaceMask(*view.layers, kPlace);
    if (std::ranges::find(mask.pixels, 1.0f) != mask.pixels.end())
      view.error = measure(ours, truth, {.mask = mask});
  }
  {
    const std::lock_guard lock(mutex_);
    if (superseded()) return;
    finished_ = published_ = std::make_shared<const ReferenceView>(std::move(view));
  }
  wake_();
}

}  // namespace gloam::view
