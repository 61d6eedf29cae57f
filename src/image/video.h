// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Frames to a video file, or to a folder of numbered pictures.
#pragma once

#include <gloam/image.h>

#include <cstdint>
#include <filesystem>
#include <memory>

namespace gloam {

/// Writes frames one after the other. A target that ends in .mp4 becomes H.264 video (yuv420p, Rec. 709; odd sizes are
/// padded by repeating the last row and column) through the program ffmpeg; a folder, or a name without extension, which
/// becomes a folder, takes frame_0000.png and so on. A video is there whole after finish() or not at all; frames of a
/// folder stay.
class VideoWriter {
 public:
  /// Width and height in pixels, 1 to 16384. Throws Error: the target cannot be written, ffmpeg is missing.
  VideoWriter(std::filesystem::path target, int width, int height, double frames_per_second);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// `display` is linear 0 to 1 (toneMapped), 1 to 4 channels; alpha is dropped in videos. Throws Error: another size,
  /// ffmpeg ended (with what it said), no space.
  void add(const Image& display);
  /// Throws Error where no frame was added or ffmpeg failed.
  void finish();
  std::int64_t frameCount() const { return frames_; }

 private:
  struct Encoder;
  std::filesystem::path target_;
  int width_, height_;
  std::int64_t frames_ = 0;
  bool finished_ = false;
  std::unique_ptr<Encoder> encoder_;  ///< null for a folder
};

}  // namespace gloam
