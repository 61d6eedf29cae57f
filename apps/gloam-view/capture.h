// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pictures and videos of what is drawn, without the panels.
#pragma once

#include <image/video.h>

#include "draw_worker.h"

namespace gloam::view {

/// What a split screen shows as one picture: left of `divider` (0 to 1) the one, right of it the other.
Image shownImage(const Drawn& drawn, const LayeredImage* right, float divider);
/// .png as shown; .exr with all layers, linear, of the left picture. Throws Error for another extension.
void savePicture(const std::string& path, const Drawn& drawn, const LayeredImage* right, float divider);

/// Every picture that is drawn while it is there becomes a frame.
class VideoCapture {
 public:
  static constexpr float kFramesPerSecond = 30.0f;
  explicit VideoCapture(std::string path) : path_(std::move(path)) {}
  void add(const Drawn& drawn, const LayeredImage* right, float divider);
  /// The number of frames.
  std::int64_t finish();
  const std::string& path() const { return path_; }
  std::int64_t frames() const { return writer_ ? writer_->frameCount() : 0; }

 private:
  std::string path_;
  int width_ = 0, height_ = 0;
  std::unique_ptr<VideoWriter> writer_;
};

}  // namespace gloam::view
