// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "golden.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace gloam::test {
namespace fs = std::filesystem;
namespace {

constexpr int kMaxSide = 128;
constexpr int kDifferenceScale = 16;

struct Difference {
  int largest = 0, x = 0, y = 0, channel = 0;
  double share = 0.0;  ///< of pixels that differ by more than one step
  Image picture;
};

Difference difference(const Image& got, const Image& want) {
  const std::vector<std::uint8_t> a = encodeSrgb8(got), b = encodeSrgb8(want);
  Difference result;
  result.picture = Image(got.width, got.height, 3);
  std::size_t differing = 0;
  for (std::size_t pixel = 0; pixel < got.pixelCount(); ++pixel) {
    int worst = 0;
    for (int c = 0; c < got.channels; ++c) {
      const std::size_t i = pixel * std::size_t(got.channels) + std::size_t(c);
      const int step = std::abs(int(a[i]) - int(b[i]));
      if (c < 3) result.picture.pixels[pixel * 3 + std::size_t(c)] = float(step * kDifferenceScale) / 255.0f;
      worst = std::max(worst, step);
      if (step <= result.largest) continue;
      result.largest = step;
      result.x = int(pixel % std::size_t(got.width));
      result.y = int(pixel / std::size_t(got.width));
      result.channel = c;
    }
    if (worst > 1) ++differing;
  }
  result.share = double(differing) / double(got.pixelCount());
  return result;
}

}  // namespace

std::string compareWithGolden(const Image& picture, const std::string& name, const GoldenTolerance& tolerance,
                              const fs::path& goldens, const fs::path& failures) {
  if (picture.width > kMaxSide || picture.height > kMaxSide)
    return fmt::format("golden {}: {} x {} pixels; at most {} a side are kept", name, picture.width,
                       picture.height, kMaxSide);
  const fs::path golden = goldens / (name + ".png"), folder = failures / name;
  const char* update = std::getenv("GLOAM_UPDATE_GOLDEN");
  if (update && std::string(update) == "1") {
    writePng(picture, golden);
    return "";
  }
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  fs::create_directories(folder);
  const std::string advice =
      fmt::format("see {}; GLOAM_UPDATE_GOLDEN=1 accepts the new picture", folder.string());
  if (!fs::exists(golden)) {
    writePng(picture, folder / "got.png");
    return fmt::format("golden {}: there is no {}; {}", name, golden.string(), advice);
  }
  const Image want = readImage(golden);
  std::string verdict;
  Difference found;
  if (want.width != picture.width || want.height != picture.height || want.channels != picture.channels) {
    verdict = fmt::format("{} x {} with {} channels, not {} x {} with {}", picture.width, picture.height,
                          picture.channels, want.width, want.height, want.channels);
  } else {
    found = difference(picture, want);
    if (found.largest > tolerance.max_difference || found.share > tolerance.share_differing)
      verdict = fmt::format(
          "differs by up to {} (channel {} at {}, {}; allowed {}), {:.2f} % of pixels (allowed {:.2f} %)",
          found.largest, found.channel, found.x, found.y, tolerance.max_difference, 100.0 * found.share,
          100.0 * tolerance.share_differing);
  }
  if (verdict.empty()) {
    fs::remove_all(folder, ignored);
    return "";
  }
  writePng(picture, folder / "got.png");
  fs::copy_file(golden, folder / "want.png");
  if (!found.picture.empty()) writePng(found.picture, folder / "diff.png");
  return fmt::format("golden {}: {}; {}", name, verdict, advice);
}

std::string compareWithGolden(const Image& picture, const std::string& name,
                              const GoldenTolerance& tolerance) {
  return compareWithGolden(picture, name, tolerance, GLOAM_GOLDEN_FOLDER, GLOAM_GOLDEN_FAILURES);
}

}  // namespace gloam::test
