// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference_worker.h"

#include <algorithm>
#include <utility>

namespace gloam::view {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kPublishSeconds = 0.7;
constexpr const char* kPlace = "reference";

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
    next_ = {state, std::move(drawn), light, bounces, max_samples};
    stop_ = true;
  }
  changed_.notify_all();
}

void ReferenceWorker::stop() {
  const std::lock_guard lock(mutex_);
  next_.reset();
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
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return quit_ || next_.has_value(); });
      if (quit_) return;
      request = std::exchange(next_, std::nullopt);
      stop_ = false;
    }
    try {
      trace(*request);
    } catch (const Interrupted&) {
    } catch (const std::exception& error) {
      auto view = std::make_shared<ReferenceView>();
      view->serial = request->drawn->serial;
      view->problem = error.what();
      const std::lock_guard lock(mutex_);
      finished_ = std::move(view);
    }
    wake_();
  }
}

void ReferenceWorker::trace(const Request& request) {
  const ViewState& state = request.state;
  ReferenceOptions options;
  options.width = request.drawn->width;
  options.height = request.drawn->height;
  options.light = request.light;
  options.bounces = request.bounces;
  options.background = state.background;
  options.threads = std::max(1, int(std::thread::hardware_concurrency()) - 1);  // one for the window
  Progress progress;
  progress.should_stop = [this] { return superseded(); };
  const PosedScene posed = poseEdited(*state.scene, state.edits, state.time_s);
  PathTracer tracer(state.scene->scene, posed, request.drawn->camera, paintedLight(state), options, progress);
  const Clock::time_point started = Clock::now();
  Clock::time_point shown = started;
  while (tracer.samples() < request.max_samples) {
    tracer.refine(tracer.samples() < 4 ? 1 : 2, progress);
    const Clock::time_point now = Clock::now();
    const bool first = tracer.samples() <= 2;
    const bool last = tracer.samples() >= request.max_samples;
    if (!first && !last && std::chrono::duration<double>(now - shown).count() < kPublishSeconds) continue;
    publish(request, tracer, std::chrono::duration<double>(now - started).count());
    shown = Clock::now();
  }
}

void ReferenceWorker::publish(const Request& request, const PathTracer& tracer, double seconds) {
  auto view = std::make_shared<ReferenceView>();
  view->serial = request.drawn->serial;
  view->samples = tracer.samples();
  view->noise = tracer.noise();
  view->seconds = seconds;
  auto layers = std::make_shared<LayeredImage>(tracer.image());
  if (request.drawn->left.layers) {
    const Image ours = request.drawn->left.layers->image("", {"R", "G", "B"}, kPlace);
    view->error = measure(ours, layers->image("", {"R", "G", "B"}, kPlace));
  }
  view->layers = std::move(layers);
  {
    const std::lock_guard lock(mutex_);
    finished_ = std::move(view);
  }
  wake_();
}

}  // namespace gloam::view
