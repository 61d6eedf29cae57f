// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "gpu/device.h"
#include "gpu/resource_state.h"

namespace gloam::gpu {

inline constexpr int kAllMips = 0;

struct ImageDesc {
  VkFormat format = VK_FORMAT_R16G16B16A16_SFLOAT;
  int width = 1, height = 1;
  int depth = 1;      ///< > 1: a 3D image
  int layers = 1;     ///< 6 n for cubes
  int mips = 1;       ///< kAllMips: down to 1 x 1
  bool cube = false;  ///< layers are faces +X -X +Y -Y +Z -Z; may also be bound as an array of 2D images
  bool operator==(const ImageDesc&) const = default;
};

/// A part of an image: consecutive mips of consecutive layers.
struct ImageRange {
  int mip = 0, mips = 1, layer = 0, layers = 1;
  bool operator==(const ImageRange&) const = default;
};

class Buffer;

/// Pixels on the device, usable as sampled and storage image and as attachment as far as the format allows
/// it. Move-only; destroying one that the device still uses is safe: it goes when the work is done.
class Image {
 public:
  Image() = default;
  /// Throws Error with the name where size, format or memory are not to be had. Contents are undefined.
  Image(Device& device, std::string name, const ImageDesc& desc);
  /// Wraps a host engine's or a swapchain's image, which stays theirs. `layout` is the one it is in now.
  static Image adopt(Device& device, std::string name, VkImage image, const ImageDesc& desc,
                     VkImageUsageFlags usage, VkImageLayout layout);
  Image(Image&& other) noexcept;
  Image& operator=(Image&& other) noexcept;
  ~Image();

  explicit operator bool() const { return image_ != VK_NULL_HANDLE; }
  Device& device() const { return *device_; }
  const std::string& name() const { return name_; }
  const ImageDesc& desc() const { return desc_; }  ///< mips as they are, never kAllMips
  int width() const { return desc_.width; }
  int height() const { return desc_.height; }
  VkFormat format() const { return desc_.format; }
  VkImage handle() const { return image_; }
  VkImageUsageFlags usage() const { return usage_; }
  std::uint64_t memoryBytes() const { return memory_bytes_; }
  ImageRange all() const { return {0, desc_.mips, 0, desc_.layers}; }
  /// Made once and kept as long as the image.
  VkImageView view(VkImageViewType type, const ImageRange& range) const;

  /// Bytes of one layer of one mip, tightly packed.
  std::size_t layerBytes(int mip = 0) const;
  /// Immediate: waits for the device, copies one layer of one mip (3D: all slices), waits. Throws Error on a
  /// wrong number of bytes.
  void uploadBytes(std::span<const std::byte> data, int mip = 0, int layer = 0);
  void downloadBytes(std::span<std::byte> data, int mip = 0, int layer = 0) const;
  template <class T>
  void upload(const std::vector<T>& data, int mip = 0, int layer = 0) {
    static_assert(std::is_trivially_copyable_v<T>);
    uploadBytes(std::as_bytes(std::span<const T>(data)), mip, layer);
  }
  template <class T>
  std::vector<T> download(int mip = 0, int layer = 0) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> result((layerBytes(mip) + sizeof(T) - 1) / sizeof(T));
    downloadBytes(std::as_writable_bytes(std::span(result)).first(layerBytes(mip)), mip, layer);
    return result;
  }
  /// Pixels as floats, the first `channels` of each (0: all), rows from the top, whatever the format: halves widened,
  /// normalised integers divided (sRGB stays encoded), integers converted.
  std::vector<float> downloadFloats(int mip = 0, int layer = 0, int channels = 0) const;
  /// The inverse: rounds to the format.
  void uploadFloats(std::span<const float> values, int mip = 0, int layer = 0);
  /// Fills mips 1 … from mip 0, each a 2 x 2 box of the one before. Immediate.
  void generateMips();

  /// What the device last did with it (bookkeeping for barriers, not part of the value).
  ResourceState& state() const { return *state_; }

 private:
  void release() noexcept;
  /// A copy that the host reads.
  Buffer downloaded(int mip, int layer) const;

  Device* device_ = nullptr;
  std::string name_;
  ImageDesc desc_;
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;  ///< null for adopted images
  VkImageUsageFlags usage_ = 0;
  std::uint64_t memory_bytes_ = 0;
  bool owned_ = false;
  struct View {
    VkImageViewType type;
    ImageRange range;
    VkImageView view;
  };
  mutable std::vector<View> views_;
  std::unique_ptr<ResourceState> state_;
};

}  // namespace gloam::gpu
