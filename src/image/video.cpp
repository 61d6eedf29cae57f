// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "image/video.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "image/atomic_file.h"
#include "image/child_process.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

std::vector<std::string> ffmpegArguments(const fs::path& file, int width, int height,
                                         double frames_per_second) {
  // "file:" keeps a name with a colon from being a protocol. sRGB in, Rec. 709 limited range out, and labelled so.
  return {"ffmpeg",
          "-hide_banner",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "rawvideo",
          "-pixel_format",
          "rgb24",
          "-video_size",
          fmt::format("{}x{}", width, height),
          "-framerate",
          fmt::format("{}", frames_per_second),
          "-i",
          "pipe:0",
          "-vf",
          "scale=in_range=pc:out_range=tv:out_color_matrix=bt709:flags=accurate_rnd",
          "-pix_fmt",
          "yuv420p",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-color_range",
          "tv",
          "-c:v",
          "libx264",
          "-preset",
          "medium",
          "-crf",
          "16",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          "file:" + file.string()};
}

bool isVideo(const fs::path& target) {
  std::string extension = target.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (fs::is_directory(target)) return false;
  if (extension == ".mp4") return true;
  if (extension.empty()) return false;
  throw Error(target.string(), "a name that ends in .mp4, or a folder for numbered pictures, was expected");
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder))
    throw Error(folder.string(),
                "cannot make this folder: " + (error ? error.message() : "a file has its name"));
}

}  // namespace

struct VideoWriter::Encoder {
  AtomicFile file;
  ChildProcess ffmpeg;
  int width, height;  ///< even
  std::vector<std::uint8_t> frame;

  Encoder(const fs::path& target, int w, int h, double frames_per_second)
      : file(target),
        ffmpeg(ffmpegArguments(fs::absolute(file.temporaryPath()), w, h, frames_per_second)),
        width(w),
        height(h),
        frame(std::size_t(w) * std::size_t(h) * 3) {}
};

VideoWriter::VideoWriter(fs::path target, int width, int height, double frames_per_second)
    : target_(std::move(target)), width_(width), height_(height) {
  constexpr int kMaxSide = 16384;
  constexpr double kMaxRate = 1000.0;
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
    throw Error(target_.string(),
                fmt::format("frames of {} x {}: 1 to {} were expected", width, height, kMaxSide));
  if (!(frames_per_second > 0.0 && frames_per_second <= kMaxRate))
    throw Error(target_.string(), fmt::format("{} frames per second: more than 0, at most {} were expected",
                                              frames_per_second, kMaxRate));
  if (!isVideo(target_)) {
    makeFolder(target_);
    return;
  }
  try {
    encoder_ =
        std::make_unique<Encoder>(target_, (width + 1) / 2 * 2, (height + 1) / 2 * 2, frames_per_second);
  } catch (const std::system_error& error) {
    if (error.code().value() == ENOENT)
      throw Error(target_.string(), "videos need the program ffmpeg (Debian: apt-get install ffmpeg)");
    throw Error(target_.string(), std::string("ffmpeg cannot be started: ") + error.code().message());
  }
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Image& display) {
  if (finished_) throw Error(target_.string(), "the video is finished; no frame can be added");
  if (display.width != width_ || display.height != height_)
    throw Error(target_.string(), fmt::format("frame {} is {} x {}; {} x {} was expected", frames_,
                                              display.width, display.height, width_, height_));
  if (!encoder_) {
    writePng(display, target_ / fmt::format("frame_{:04}.png", frames_++));
    return;
  }
  const std::vector<std::uint8_t> bytes = encodeSrgb8(display);
  const std::size_t channels = std::size_t(display.channels), green = channels >= 3 ? 1 : 0;
  std::uint8_t* out = encoder_->frame.data();
  for (int y = 0; y < encoder_->height; ++y)
    for (int x = 0; x < encoder_->width; ++x, out += 3) {
      const std::size_t pixel =
          std::size_t(std::min(y, height_ - 1)) * std::size_t(width_) + std::size_t(std::min(x, width_ - 1));
      const std::uint8_t* in = &bytes[pixel * channels];
      out[0] = in[0];
      out[1] = in[green];
      out[2] = in[2 * green];
    }
  if (!encoder_->ffmpeg.send(encoder_->frame.data(), encoder_->frame.size())) {
    encoder_->ffmpeg.wait();
    throw Error(target_.string(),
                fmt::format("ffmpeg ended at frame {}: {}", frames_, encoder_->ffmpeg.lastWords()));
  }
  ++frames_;
}

void VideoWriter::finish() {
  if (frames_ == 0) throw Error(target_.string(), "a video without frames cannot be written");
  finished_ = true;
  if (!encoder_) return;
  if (const int status = encoder_->ffmpeg.wait(); status != 0)
    throw Error(target_.string(),
                fmt::format("ffmpeg failed ({}): {}", status, encoder_->ffmpeg.lastWords()));
  encoder_->file.commit();
  encoder_.reset();
}

}  // namespace gloam
