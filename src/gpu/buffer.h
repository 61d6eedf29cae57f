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

struct BufferDesc {
  std::size_t bytes = 0;      ///< 0 is allowed: nothing to read, but something to bind
  bool host_visible = false;  ///< can be mapped: for data that host passes exchange with the device
  bool host_writes = false;   ///< the host fills it every frame: mapped, in memory that the device reads fast
  bool by_address = false;    ///< larger than one binding may be; shaders reach it through address()
  bool operator==(const BufferDesc&) const = default;
};

/// Bytes on the device, usable as storage, uniform, index and indirect buffer. Move-only; destroying one that
/// the device still uses is safe: it goes when the work is done.
class Buffer {
 public:
  Buffer() = default;
  /// Throws Error with name and size where it is larger than a storage binding or the memory is not there.
  /// Contents are undefined.
  Buffer(Device& device, std::string name, const BufferDesc& desc);
  /// As large as `data`, and filled with it.
  template <class T>
  Buffer(Device& device, std::string name, std::span<const T> data)
      : Buffer(device, std::move(name), BufferDesc{.bytes = data.size_bytes()}) {
    upload(data);
  }
  template <class T>
  Buffer(Device& device, std::string name, const std::vector<T>& data)
      : Buffer(device, std::move(name), std::span<const T>(data)) {}
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;
  ~Buffer();

  explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }
  Device& device() const { return *device_; }
  const std::string& name() const { return name_; }
  const BufferDesc& desc() const { return desc_; }
  std::size_t bytes() const { return desc_.bytes; }
  VkBuffer handle() const { return buffer_; }
  /// For GL_EXT_buffer_reference; throws Error where the device has no buffer addresses.
  VkDeviceAddress address() const;
  /// host_visible and host_writes only, else null. Valid as long as the buffer; the device must not be using it.
  std::byte* mapped() const;

  /// Immediate: waits for the device, copies, waits. Throws Error where it does not fit. Inside a frame use
  /// FrameGraph::upload instead.
  void uploadBytes(std::span<const std::byte> data, std::size_t offset = 0);
  void downloadBytes(std::span<std::byte> data, std::size_t offset = 0) const;
  template <class T>
  void upload(std::span<const T> data, std::size_t offset_bytes = 0) {
    static_assert(std::is_trivially_copyable_v<T>);
    uploadBytes(std::as_bytes(data), offset_bytes);
  }
  template <class T>
  void upload(const std::vector<T>& data, std::size_t offset_bytes = 0) {
    upload(std::span<const T>(data), offset_bytes);
  }
  /// All of it as Ts; what does not fill a T is left out.
  template <class T>
  std::vector<T> download() const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> result(bytes() / sizeof(T));
    downloadBytes(std::as_writable_bytes(std::span(result)));
    return result;
  }

  /// What the device last did with it (bookkeeping for barriers, not part of the value).
  ResourceState& state() const { return *state_; }

 private:
  void release() noexcept;

  Device* device_ = nullptr;
  std::string name_;
  BufferDesc desc_;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  std::byte* mapped_ = nullptr;
  std::unique_ptr<ResourceState> state_;
};

}  // namespace gloam::gpu
