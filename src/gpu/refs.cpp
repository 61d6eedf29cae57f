// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/refs.h"

#include <algorithm>
#include <string>

namespace gloam::gpu {
namespace {

void checkIndex(const std::string& place, const char* what, int index, int count) {
  if (index >= 0 && index < count) return;
  throw Error(
      place, std::string(what) + " " + std::to_string(index) + " is not one of its " + std::to_string(count));
}

}  // namespace

ImageRef ImageRef::mip(int mip) const {
  checkIndex(name(), "mip", mip, range_.mips);
  ImageRef part = *this;
  part.range_.mip += mip;
  part.range_.mips = 1;
  return part;
}

ImageRef ImageRef::layer(int layer) const {
  return layers(layer, 1);
}

ImageRef ImageRef::layers(int first, int count) const {
  checkIndex(name(), "layer", first, range_.layers);
  checkIndex(name(), "layer", first + count - 1, range_.layers);
  ImageRef part = *this;
  part.range_.layer += first;
  part.range_.layers = count;
  return part;
}

int ImageRef::width() const {
  return std::max(1, image_->desc().width >> range_.mip);
}
int ImageRef::height() const {
  return std::max(1, image_->desc().height >> range_.mip);
}
int ImageRef::depth() const {
  return std::max(1, image_->desc().depth >> range_.mip);
}

BufferRef BufferRef::slice(std::size_t offset, std::size_t bytes) const {
  if (offset > bytes_ || bytes > bytes_ - offset) {
    throw Error(name(), "bytes " + std::to_string(offset) + " to " + std::to_string(offset + bytes) +
                            " are not inside its " + std::to_string(bytes_));
  }
  BufferRef part = *this;
  part.offset_ += offset;
  part.bytes_ = bytes;
  return part;
}

}  // namespace gloam::gpu
