// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "output.h"

#include <fmt/core.h>

#include <image/atomic_file.h>
#include <image/video.h>

#include "show.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kForms =
    "expected .png, .exr, .hdr, .mp4, a folder, or a numbered name such as frame_####.png";

bool isPicture(const std::string& extension) {
  return extension == ".png" || extension == ".exr" || extension == ".hdr";
}

/// Pictures, each in a file of its own: the name is fixed, or holds a run of # that becomes the frame's number.
class PictureOutput : public FrameOutput {
 public:
  PictureOutput(const OutputRequest& request, fs::path pattern)
      : pattern_(std::move(pattern)), layer_(request.layer) {
    makeFolder();
    try {
      AtomicFile probe(nameOf(0));
    } catch (const Error&) {
      removeOwnFolder();
      throw;
    }
  }
  ~PictureOutput() override { removeOwnFolder(); }

  void write(const LayeredImage& frame, const DisplayOptions& display) override {
    const fs::path path = nameOf(written_.size());
    if (path.extension() == ".png") {
      writePng(shownPicture(frame, layer_, display), path);
    } else if (path.extension() == ".exr" && layer_.empty()) {
      writeExr(frame, path);
    } else {
      const bool numbers =
          layer_.empty() || layer_ == "direct" || layer_ == "indirect" || !isFrameLayer(layer_);
      writeImage(numbers ? lightOf(frame, layer_) : shownPicture(frame, layer_, display), path);
    }
    written_.push_back(path);
  }

  std::vector<fs::path> finish() override { return written_; }

 private:
  fs::path nameOf(std::size_t index) const {
    std::string name = pattern_.filename().string();
    const std::size_t first = name.find('#');
    if (first == std::string::npos) return pattern_;
    const std::size_t count = std::min(name.find_first_not_of('#', first), name.size()) - first;
    name.replace(first, count, fmt::format("{:0{}}", index, count));
    return pattern_.parent_path() / name;
  }

  // Only the last folder: a mistyped path should not grow a tree.
  void makeFolder() {
    const fs::path folder = pattern_.parent_path();
    if (pattern_.filename().string().find('#') == std::string::npos || folder.empty()) return;
    std::error_code error;
    if (fs::is_directory(folder, error)) return;
    made_folder_ = fs::create_directory(folder, error);
    if (error) throw Error(folder.string(), fmt::format("cannot make this folder: {}", error.message()));
  }

  void removeOwnFolder() {
    std::error_code ignored;
    if (made_folder_ && written_.empty()) fs::remove(pattern_.parent_path(), ignored);
  }

  fs::path pattern_;
  std::string layer_;
  bool made_folder_ = false;
  std::vector<fs::path> written_;
};

class VideoOutput : public FrameOutput {
 public:
  explicit VideoOutput(const OutputRequest& request)
      : path_(request.path),
        layer_(request.layer),
        video_(request.path, request.width, request.height, request.frames_per_second) {}

  void write(const LayeredImage& frame, const DisplayOptions& display) override {
    video_.add(shownPicture(frame, layer_, display));
    ++count_;
  }

  std::vector<fs::path> finish() override {
    if (count_ == 0) return {};
    video_.finish();
    return {path_};
  }

 private:
  fs::path path_;
  std::string layer_;
  VideoWriter video_;
  std::size_t count_ = 0;
};

}  // namespace

std::unique_ptr<FrameOutput> openOutput(const OutputRequest& request) {
  const fs::path& path = request.path;
  const std::string extension = path.extension().string();
  std::error_code ignored;
  if (extension.empty() && fs::exists(path, ignored) && !fs::is_directory(path, ignored)) {
    throw Error(path.string(),
                fmt::format("is no folder, and its name does not tell what to write; {}", kForms));
  }
  if (fs::is_directory(path, ignored) || extension.empty() || !path.has_filename()) {
    return std::make_unique<PictureOutput>(request, path / "frame_####.png");
  }
  if (extension == ".mp4") return std::make_unique<VideoOutput>(request);
  if (!isPicture(extension)) {
    throw Error(path.string(), fmt::format("unknown extension '{}'; {}", extension, kForms));
  }
  if (request.frames > 1 && path.filename().string().find('#') == std::string::npos) {
    throw Error(
        path.string(),
        fmt::format(
            "holds one picture, {} frames were asked for; name a folder, a video (.mp4), or {}_####{}",
            request.frames, path.stem().string(), extension));
  }
  return std::make_unique<PictureOutput>(request, path);
}

void refuseOverwriting(const fs::path& output, const std::string& input) {
  std::error_code ignored;
  if (fs::equivalent(output, input, ignored)) {
    throw Error(output.string(), "is read by this command: writing it would destroy the input");
  }
}

}  // namespace gloam::cli
