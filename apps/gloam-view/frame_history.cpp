// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame_history.h"

#include <fmt/core.h>

#include <utility>

namespace gloam::view {

void FrameHistory::clear() {
  samples_.clear();
  rows_.clear();
  of_.clear();
}

// The first picture of a size compiles shaders and makes images: it tells nothing of those that follow.
void FrameHistory::add(const Drawn& drawn) {
  const std::string of = fmt::format("{} {}x{} {}", drawn.technique, drawn.width, drawn.height, drawn.split);
  if (of != of_ || std::exchange(provisional_, false)) {
    provisional_ = of != of_;  // shown until there is another
    clear();
    of_ = of;
  }
  samples_.push_back({drawn.left.frame_ms, drawn.left.passes});
  if (samples_.size() > kKept) samples_.pop_front();
  cli::Timings timings;
  std::vector<double> frame_ms;
  for (const Sample& sample : samples_) {
    RenderedFrame frame;
    frame.passes = sample.passes;
    timings.add(frame, sample.frame_ms);
    frame_ms.push_back(sample.frame_ms);
  }
  median_ms_ = cli::quantile(frame_ms, 0.5);
  p95_ms_ = cli::quantile(frame_ms, 0.95);
  passes_ = timings.passesJson();
  rows_.clear();
  for (const auto& pass : passes_) rows_.push_back({pass["name"], pass["median_ms"], pass["p95_ms"]});
}

std::vector<float> FrameHistory::frameMs() const {
  std::vector<float> values;
  for (const Sample& sample : samples_) values.push_back(float(sample.frame_ms));
  return values;
}

cli::Json FrameHistory::json(const Drawn& drawn, const std::string& scene, double ui_device_ms) const {
  cli::Json memory = cli::Json::array();
  for (const MemoryUse& use : drawn.memory) memory.push_back({{"name", use.name}, {"bytes", use.bytes}});
  return {{"device", drawn.device.name},
          {"technique", drawn.technique},
          {"scene", scene},
          {"size", fmt::format("{}x{}", drawn.width, drawn.height)},
          {"frames", samples_.size()},
          {"passes", passes_},
          {"frame_ms", median_ms_},
          {"frame_p95_ms", p95_ms_},
          {"ui_device_ms", ui_device_ms},
          {"memory_bytes", drawn.memory_bytes},
          {"memory", memory}};
}

}  // namespace gloam::view
