// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame_history.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace gloam::view {

void FrameHistory::clear() {
  samples_.clear();
  rows_.clear();
  of_.clear();
  passes_ = cli::Json::array();
  median_ms_ = p95_ms_ = 0.0;
  counted_ = 0;
}

void FrameHistory::add(const Drawn& drawn) {
  const std::string of = drawn.technique + " " + drawn.right_technique;
  if (of != of_) clear();
  of_ = of;
  const std::string size = fmt::format("{}x{}", drawn.width, drawn.height);
  const bool first = samples_.empty() || samples_.back().size != size;
  std::vector<PassTime> passes = drawn.left.passes;
  passes.insert(passes.end(), drawn.right.passes.begin(), drawn.right.passes.end());
  samples_.push_back({size, first, drawn.left.frame_ms + drawn.right.frame_ms, std::move(passes)});
  if (samples_.size() > kKept) samples_.pop_front();
  measure();
}

/// Of samples of the newest one's size; of those that came first only where there are no others.
void FrameHistory::measure() {
  const std::string& size = samples_.back().size;
  const auto isOf = [&](const Sample& s) { return s.size == size; };
  const bool others = std::ranges::any_of(samples_, [&](const Sample& s) { return isOf(s) && !s.first; });
  cli::Timings timings;
  std::vector<double> frame_ms;
  for (const Sample& sample : samples_) {
    if (!isOf(sample) || (others && sample.first)) continue;
    RenderedFrame frame;
    frame.passes = sample.passes;
    timings.add(frame, sample.frame_ms);
    frame_ms.push_back(sample.frame_ms);
  }
  counted_ = frame_ms.size();
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
          {"frames", counted_},
          {"passes", passes_},
          {"frame_ms", median_ms_},
          {"frame_p95_ms", p95_ms_},
          {"ui_device_ms", ui_device_ms},
          {"memory_bytes", drawn.memory_bytes},
          {"memory", memory}};
}

}  // namespace gloam::view
