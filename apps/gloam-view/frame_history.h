// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Times of the last pictures of one technique at one size: for the plot, the table of passes and the JSON.
#pragma once

#include <deque>

#include "draw_worker.h"
#include "timings.h"

namespace gloam::view {

class FrameHistory {
 public:
  static constexpr std::size_t kKept = 120;

  void add(const Drawn& drawn);
  void clear();
  std::vector<float> frameMs() const;  ///< the oldest first
  struct Row {
    std::string name;
    double median_ms, p95_ms;
  };
  const std::vector<Row>& rows() const { return rows_; }
  double medianMs() const { return median_ms_; }
  double p95Ms() const { return p95_ms_; }
  /// As `gloam bench --json` has it, with memory by resource.
  cli::Json json(const Drawn& drawn, const std::string& scene, double ui_device_ms) const;

 private:
  struct Sample {
    double frame_ms;
    std::vector<PassTime> passes;
  };
  std::deque<Sample> samples_;
  std::string of_;            ///< technique and size
  bool provisional_ = false;  ///< the one sample is the first of its kind
  std::vector<Row> rows_;
  double median_ms_ = 0.0, p95_ms_ = 0.0;
  cli::Json passes_ = cli::Json::array();
};

}  // namespace gloam::view
