// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/buffer.h"
#include "gpu/image.h"

namespace gloam::gpu {

/// An image, or some mips and layers of it, as passes name it. Does not own: the image outlives the frame.
class ImageRef {
 public:
  ImageRef() = default;
  ImageRef(const Image& image) : image_(&image), range_(image.all()) {}  // NOLINT: meant to be implicit
  explicit operator bool() const { return image_ != nullptr; }

  /// One mip of the layers that this refers to; counted from 0 within them. Out of range: Error.
  ImageRef mip(int mip) const;
  ImageRef layer(int layer) const;
  ImageRef layers(int first, int count) const;

  const Image& image() const { return *image_; }
  const ImageRange& range() const { return range_; }
  const std::string& name() const { return image_->name(); }
  VkFormat format() const { return image_->format(); }
  int width() const;  ///< of the first mip that this refers to
  int height() const;
  int depth() const;

 private:
  const Image* image_ = nullptr;
  ImageRange range_;
};

/// A buffer or a part of it. Does not own: the buffer outlives the frame.
class BufferRef {
 public:
  BufferRef() = default;
  BufferRef(const Buffer& buffer)
      : buffer_(&buffer), bytes_(buffer.bytes()) {}  // NOLINT: meant to be implicit
  explicit operator bool() const { return buffer_ != nullptr; }

  /// The offset is a multiple of 256 where shaders bind it. Out of range: Error.
  BufferRef slice(std::size_t offset, std::size_t bytes) const;

  const Buffer& buffer() const { return *buffer_; }
  std::size_t offset() const { return offset_; }
  std::size_t bytes() const { return bytes_; }
  const std::string& name() const { return buffer_->name(); }

 private:
  const Buffer* buffer_ = nullptr;
  std::size_t offset_ = 0, bytes_ = 0;
};

}  // namespace gloam::gpu
