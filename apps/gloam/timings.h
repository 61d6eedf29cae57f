// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/renderer.h>

#include <string>
#include <vector>

#include "json.h"

namespace gloam::cli {

/// The times of many frames, pass by pass.
class Timings {
 public:
  /// `frame_ms`: wall clock of the whole call; `cpu_ms`: what all threads of this program computed in it.
  void add(const RenderedFrame& frame, double frame_ms, double cpu_ms = 0.0);

  double medianFrameMs() const;
  double medianCpuMs() const;
  /// Of the passes whose names begin so, together.
  double medianMs(const std::string& prefix) const;
  /// Of all passes of a frame together.
  double medianPassesMs() const;
  std::size_t memoryBytes() const { return memory_bytes_; }
  /// [{"name", "median_ms", "p95_ms"}], in the order in which passes run.
  Json passesJson() const;
  /// The same as lines of a table.
  std::vector<std::string> table() const;

 private:
  struct Pass {
    std::string name;
    std::vector<double> milliseconds;
  };
  std::vector<Pass> passes_;
  std::vector<double> frame_ms_, passes_ms_, cpu_ms_;
  std::size_t memory_bytes_ = 0;
};

/// With GLOAM_VALIDATION=1: throws Error where the validation layer had something to say.
void checkValidation(const Renderer& renderer);

/// The value below which the part `fraction` of the samples lies, between neighbours linearly; 0 for none.
double quantile(std::vector<double> samples, double fraction);

}  // namespace gloam::cli
