// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The path tracer in the background: more and more samples of the picture that stands still, and how far the technique is from
// them.
#pragma once

#include <gloam/metrics.h>
#include <gloam/reference.h>

#include <atomic>
#include <optional>

#include "draw_worker.h"

namespace gloam::view {

struct ReferenceView {
  std::shared_ptr<const LayeredImage> layers;
  int samples = 0;
  double noise = 0.0;  ///< the relative RMSE that it makes by itself; infinite where that is not known yet
  double seconds = 0.0;
  std::optional<Metrics> error;  ///< of the technique against it, on surfaces
  std::string problem;           ///< why there is none
};

class ReferenceWorker {
 public:
  explicit ReferenceWorker(std::function<void()> wake);
  ~ReferenceWorker();
  ReferenceWorker(const ReferenceWorker&) = delete;
  ReferenceWorker& operator=(const ReferenceWorker&) = delete;

  /// Begins anew: the same view as `drawn`, whose picture is measured against it. `light` says which light is followed.
  void start(const ViewState& state, std::shared_ptr<const Drawn> drawn, const Coverage& light, int bounces,
             int max_samples);
  /// Measures another picture of the same view and size against the same samples, those that are there and those to come.
  void compare(std::shared_ptr<const Drawn> drawn);
  void stop();
  std::shared_ptr<const ReferenceView> take();

 private:
  struct Request {
    ViewState state;
    PosedCamera camera;
    int width, height;
    Coverage light;
    int bounces, max_samples;
  };
  void run();
  void trace(const Request& request);
  bool superseded() const;
  void publish(ReferenceView view);

  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Request> next_;
  std::shared_ptr<const Drawn> compared_;           ///< what is measured
  std::shared_ptr<const ReferenceView> published_;  ///< last
  bool measure_again_ = false;
  std::shared_ptr<const ReferenceView> finished_;
  std::atomic<bool> quit_ = false, stop_ = false;
  std::thread thread_;
};

}  // namespace gloam::view
