// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/buffer.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "gpu/device_state.h"

namespace gloam::gpu {
namespace {

constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                      VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                                      VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                      VK_BUFFER_USAGE_TRANSFER_DST_BIT;

void checkSize(const Device& device, const std::string& name, const BufferDesc& desc) {
  if (desc.by_address && !device.features().buffer_device_address) {
    throw Error(name, "is to be reached by address, which '" + device.info().name + "' cannot");
  }
  if (!desc.by_address && desc.bytes > device.limits().max_storage_bytes) {
    throw Error(name, "a buffer of " + std::to_string(desc.bytes) + " bytes is larger than the " +
                          std::to_string(device.limits().max_storage_bytes) + " that '" + device.info().name +
                          "' binds at once");
  }
}

void checkRange(const Buffer& buffer, std::size_t offset, std::size_t bytes, const char* what) {
  if (offset <= buffer.bytes() && bytes <= buffer.bytes() - offset) return;
  throw Error(buffer.name(), std::string(what) + " of " + std::to_string(bytes) + " bytes at " +
                                 std::to_string(offset) + " does not fit into its " +
                                 std::to_string(buffer.bytes()));
}

constexpr Access kCopyFrom{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr Access kCopyTo{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};

}  // namespace

Buffer::Buffer(Device& device, std::string name, const BufferDesc& desc)
    : device_(&device), name_(std::move(name)), desc_(desc), state_(std::make_unique<ResourceState>()) {
  checkSize(device, name_, desc);
  DeviceState& state = device.state();
  const bool addressable = device.features().buffer_device_address;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = std::max<VkDeviceSize>((desc.bytes + 3) & ~std::size_t{3},
                                     16);  // fills write whole words; none is empty
  info.usage = kUsage;
  if (addressable) info.usage |= VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  check(state.vk.vkCreateBuffer(state.device, &info, nullptr, &buffer_), name_, "vkCreateBuffer");
  try {
    VkMemoryRequirements requirements;
    state.vk.vkGetBufferMemoryRequirements(state.device, buffer_, &requirements);
    const MemoryKind kind = desc.host_visible  ? MemoryKind::kHost
                            : desc.host_writes ? MemoryKind::kHostWrites
                                               : MemoryKind::kDevice;
    const auto allocation = state.allocate(name_, requirements, kind, addressable);
    memory_ = allocation.memory;
    mapped_ = allocation.mapped;
    check(state.vk.vkBindBufferMemory(state.device, buffer_, memory_, 0), name_, "vkBindBufferMemory");
    state.nameObject(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer_), name_);
    state_->parts.resize(1);
    state.memory[buffer_] = {name_, requirements.size};
  } catch (...) {
    release();
    throw;
  }
}

Buffer::Buffer(Buffer&& other) noexcept {
  *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  if (this == &other) return *this;
  release();
  device_ = other.device_;
  name_ = std::move(other.name_);
  desc_ = other.desc_;
  buffer_ = std::exchange(other.buffer_, VK_NULL_HANDLE);
  memory_ = std::exchange(other.memory_, VK_NULL_HANDLE);
  mapped_ = std::exchange(other.mapped_, nullptr);
  state_ = std::move(other.state_);
  return *this;
}

Buffer::~Buffer() {
  release();
}

void Buffer::release() noexcept {
  if (buffer_ == VK_NULL_HANDLE) return;
  DeviceState& state = device_->state();
  state.memory.erase(buffer_);
  state.retire([&state, buffer = buffer_, memory = memory_] {
    state.vk.vkDestroyBuffer(state.device, buffer, nullptr);
    state.vk.vkFreeMemory(state.device, memory, nullptr);
  });
  buffer_ = VK_NULL_HANDLE;
}

VkDeviceAddress Buffer::address() const {
  if (!device_->features().buffer_device_address) {
    throw Error(name_, "'" + device_->info().name + "' has no buffer addresses");
  }
  VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
  info.buffer = buffer_;
  return device_->vk().vkGetBufferDeviceAddress(device_->handle(), &info);
}

std::byte* Buffer::mapped() const {
  return desc_.host_visible || desc_.host_writes ? mapped_ : nullptr;
}

void Buffer::uploadBytes(std::span<const std::byte> data, std::size_t offset) {
  checkRange(*this, offset, data.size(), "an upload");
  if (data.empty()) return;
  device_->wait();
  if (mapped_ != nullptr) {
    std::memcpy(mapped_ + offset, data.data(), data.size());
    return;
  }
  Buffer staging(*device_, name_ + ".staging",
                 BufferDesc{.bytes = data.size(), .host_visible = true, .by_address = desc_.by_address});
  std::memcpy(staging.mapped_, data.data(), data.size());
  device_->runNow([&](VkCommandBuffer commands) {
    BarrierBatch barriers;
    barriers.add(*this, kCopyTo);
    barriers.record(*device_, commands);
    const VkBufferCopy region{0, offset, data.size()};
    device_->vk().vkCmdCopyBuffer(commands, staging.buffer_, buffer_, 1, &region);
  });
}

void Buffer::downloadBytes(std::span<std::byte> data, std::size_t offset) const {
  checkRange(*this, offset, data.size(), "a read-back");
  if (data.empty()) return;
  device_->wait();
  if (mapped_ != nullptr) {
    std::memcpy(data.data(), mapped_ + offset, data.size());
    return;
  }
  const Buffer staging(
      *device_, name_ + ".staging",
      BufferDesc{.bytes = data.size(), .host_visible = true, .by_address = desc_.by_address});
  device_->runNow([&](VkCommandBuffer commands) {
    BarrierBatch barriers;
    barriers.add(*this, kCopyFrom);
    barriers.record(*device_, commands);
    const VkBufferCopy region{offset, 0, data.size()};
    device_->vk().vkCmdCopyBuffer(commands, buffer_, staging.buffer_, 1, &region);
  });
  std::memcpy(data.data(), staging.mapped_, data.size());
}

}  // namespace gloam::gpu
