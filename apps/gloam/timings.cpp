// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "timings.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace gloam::cli {

void checkValidation(const Renderer& renderer) {
  if (const int count = renderer.validationMessages(); count > 0) {
    throw Error("GLOAM_VALIDATION", fmt::format("{} messages of the validation layer", count));
  }
}

double quantile(std::vector<double> samples, double fraction) {
  if (samples.empty()) return 0.0;
  std::ranges::sort(samples);
  const double at = fraction * double(samples.size() - 1);
  const auto below = std::size_t(at);
  const std::size_t above = std::min(below + 1, samples.size() - 1);
  return samples[below] + (at - double(below)) * (samples[above] - samples[below]);
}

// A pass that runs several times in a frame (one shadow map a light) counts as one, with the sum of its times.
void Timings::add(const RenderedFrame& frame, double frame_ms, double cpu_ms) {
  frame_ms_.push_back(frame_ms);
  cpu_ms_.push_back(cpu_ms);
  memory_bytes_ = std::max(memory_bytes_, frame.memory_bytes);
  std::map<std::string, double> sums;
  double all = 0.0;
  for (const PassTime& pass : frame.passes) {
    sums[pass.name] += pass.milliseconds;
    all += pass.milliseconds;
  }
  passes_ms_.push_back(all);
  for (const PassTime& pass : frame.passes) {
    const auto sum = sums.find(pass.name);
    if (sum == sums.end()) continue;
    auto known = std::ranges::find(passes_, pass.name, &Pass::name);
    if (known == passes_.end()) known = passes_.insert(passes_.end(), {pass.name, {}});
    known->milliseconds.push_back(sum->second);
    sums.erase(sum);
  }
}

double Timings::medianFrameMs() const {
  return quantile(frame_ms_, 0.5);
}

double Timings::medianPassesMs() const {
  return quantile(passes_ms_, 0.5);
}

double Timings::medianCpuMs() const {
  return quantile(cpu_ms_, 0.5);
}

double Timings::medianMs(const std::string& prefix) const {
  std::vector<double> sums(frame_ms_.size(), 0.0);
  for (const Pass& pass : passes_) {
    if (!pass.name.starts_with(prefix)) continue;
    for (std::size_t i = 0; i < std::min(sums.size(), pass.milliseconds.size()); ++i)
      sums[i] += pass.milliseconds[i];
  }
  return quantile(sums, 0.5);
}

Json Timings::passesJson() const {
  Json json = Json::array();
  for (const Pass& pass : passes_) {
    json.push_back({{"name", pass.name},
                    {"median_ms", quantile(pass.milliseconds, 0.5)},
                    {"p95_ms", quantile(pass.milliseconds, 0.95)}});
  }
  return json;
}

std::vector<std::string> Timings::table() const {
  std::size_t width = 8;
  for (const Pass& pass : passes_) width = std::max(width, pass.name.size());
  std::vector<std::string> lines = {
      fmt::format("{:<{}}  {:>10}  {:>10}", "pass", width, "median ms", "p95 ms")};
  double sum = 0.0;
  for (const Pass& pass : passes_) {
    const double median = quantile(pass.milliseconds, 0.5);
    sum += median;
    lines.push_back(fmt::format("{:<{}}  {:>10.3f}  {:>10.3f}", pass.name, width, median,
                                quantile(pass.milliseconds, 0.95)));
  }
  lines.push_back(fmt::format("{:<{}}  {:>10.3f}", "sum", width, sum));
  lines.push_back(fmt::format("{:<{}}  {:>10.3f}  {:>10.3f}", "frame", width, medianFrameMs(),
                              quantile(frame_ms_, 0.95)));
  if (const double cpu_ms = medianCpuMs(); cpu_ms > 0.0)
    lines.push_back(fmt::format("{:<{}}  {:>10.3f}  {:>10.3f}  of processor time, all threads together",
                                "frame", width, cpu_ms, quantile(cpu_ms_, 0.95)));
  return lines;
}

}  // namespace gloam::cli
