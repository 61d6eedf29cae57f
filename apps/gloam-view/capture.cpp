// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "capture.h"

#include <algorithm>

#include "show.h"

namespace gloam::view {
namespace {

Image threeChannels(const Image& image) {
  Image rgb(image.width, image.height, 3);
  for (std::size_t i = 0; i < image.pixelCount(); ++i) {
    for (int c = 0; c < 3; ++c)
      rgb.pixels[3 * i + std::size_t(c)] =
          image.pixels[i * std::size_t(image.channels) + std::size_t(std::min(c, image.channels - 1))];
  }
  return rgb;
}

}  // namespace

Image shownImage(const Drawn& drawn, const LayeredImage* right, float divider) {
  if (!drawn.left.layers) throw Error("capture", "nothing is drawn yet");
  Image picture = cli::shownPicture(*drawn.left.layers, drawn.show, drawn.display);
  if (right == nullptr) return picture;
  picture = threeChannels(picture);
  const std::string show = right->find(drawn.show) != nullptr ? drawn.show : "";
  const Image other = threeChannels(cli::shownPicture(*right, show, drawn.display));
  for (int y = 0; y < picture.height; ++y) {
    for (int x = int(divider * float(picture.width)); x < picture.width; ++x) {
      const int from_x = x * other.width / picture.width, from_y = y * other.height / picture.height;
      std::copy_n(other.at(from_x, from_y), 3, picture.at(x, y));
    }
  }
  return picture;
}

void savePicture(const std::string& path, const Drawn& drawn, const LayeredImage* right, float divider) {
  if (path.ends_with(".exr")) {
    if (!drawn.left.layers) throw Error("capture", "nothing is drawn yet");
    writeExr(*drawn.left.layers, path);
    return;
  }
  if (!path.ends_with(".png")) throw Error(path, "expected a name that ends in .png or .exr");
  writePng(shownImage(drawn, right, divider), path);
}

void VideoCapture::add(const Drawn& drawn, const LayeredImage* right, float divider) {
  const Image picture = shownImage(drawn, right, divider);
  if (!writer_) {
    width_ = picture.width;
    height_ = picture.height;
    writer_ = std::make_unique<VideoWriter>(path_, width_, height_, double(kFramesPerSecond));
  }
  if (picture.width == width_ && picture.height == height_) writer_->add(picture);
}

std::int64_t VideoCapture::finish() {
  if (!writer_) return 0;
  writer_->finish();
  return writer_->frameCount();
}

}  // namespace gloam::view
