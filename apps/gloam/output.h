// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Where frames go: a picture, numbered pictures in a folder, a video.
#pragma once

#include <gloam/renderer.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace gloam::cli {

struct OutputRequest {
  std::filesystem::path path;
  std::size_t frames = 1;
  int width = 0, height = 0;
  float frames_per_second = 30.0f;
  std::string layer;  ///< shown instead of the sum; empty: the sum
};

/// Takes finished frames in order. Made before the first is drawn, so that a target that cannot be written is found at
/// once. What was written stays, whatever happens later; what was not finished leaves no trace.
class FrameOutput {
 public:
  virtual ~FrameOutput() = default;
  virtual void write(const LayeredImage& frame, const DisplayOptions& display) = 0;
  /// Closes what is open; the files that came to be.
  virtual std::vector<std::filesystem::path> finish() = 0;
};

/// By the name's form: x.png, x.exr and x.hdr hold one frame; x_####.png is numbered; x.mp4 is a video; a name without an
/// extension, or a folder that is there, gets frame_0000.png and so on. Throws Error for another extension, many frames
/// for one picture, a place that cannot be written, and a video where there is no ffmpeg.
std::unique_ptr<FrameOutput> openOutput(const OutputRequest& request);

/// Throws Error where writing the output would destroy an input.
void refuseOverwriting(const std::filesystem::path& output, const std::string& input);

}  // namespace gloam::cli
