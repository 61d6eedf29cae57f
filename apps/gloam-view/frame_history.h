// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Times of the last pictures of one technique: for the plot. Those of the newest one's size: for the table of passes and the
// JSON.
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
  std::vector<float> frameMs() const;  ///< of whatever size, the oldest first
  struct Row {
    std::string name;
    double median_ms, p95_ms;
  };
  const std::vector<Row>& rows() const { return rows_; }
  double medianMs() const { return median_ms_; }
  double p95Ms() const { return p95_ms_; }
  std::size_t counted() const { return counted_; }  ///< pictures of the newest one's size, which these are of
  /// As `gloam bench --json` has it, with memory by resource.
  cli::Json json(const Drawn& drawn, const std::string& scene, double ui_device_ms) const;

 private:
  struct Sample {
    std::string size;
    bool first;  ///< after another size or technique: it makes images, or compiles shaders
    double frame_ms;
    std::vector<PassTime> passes;
  };
  void measure();

  std::deque<Sample> samples_;
  std::string of_;           ///< techniques
  std::size_t counted_ = 0;  ///< samples of the newest one's size
  std::vector<Row> rows_;
  double median_ms_ = 0.0, p95_ms_ = 0.0;
  cli::Json passes_ = cli::Json::array();
};

}  // namespace gloam::view
