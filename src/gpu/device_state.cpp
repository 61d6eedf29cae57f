// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Submission, memory, samplers, and the deferred end of objects that the device may still use.
#include "gpu/device_state.h"

#include <algorithm>

namespace gloam::gpu {
namespace {

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MiB";
}

}  // namespace

void DeviceState::initialize() {
  instance.functions.getPhysicalDeviceMemoryProperties(physical_device, &memory_properties);
  limits = readLimits(instance.functions, physical_device, queue_family);
  VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type};
  check(vk.vkCreateSemaphore(device, &semaphore, nullptr, &timeline), "gpu", "vkCreateSemaphore");
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  pool.queueFamilyIndex = queue_family;
  check(vk.vkCreateCommandPool(device, &pool, nullptr, &command_pool), "gpu", "vkCreateCommandPool");
  VkPipelineCacheCreateInfo cache{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  check(vk.vkCreatePipelineCache(device, &cache, nullptr, &pipeline_cache), "gpu", "vkCreatePipelineCache");
}

void DeviceState::destroy() {
  if (device != VK_NULL_HANDLE && vk.vkDestroySemaphore != nullptr) {
    try {
      if (timeline != VK_NULL_HANDLE) waitFor(submitted);
    } catch (const Error&) {  // a lost device has finished all it will ever do
    }
    for (auto& [value, destroy_one] : retired) destroy_one();
    retired.clear();
    programs.clear();
    for (auto& [desc, handle] : samplers) vk.vkDestroySampler(device, handle, nullptr);
    samplers.clear();
    vk.vkDestroyPipelineCache(device, pipeline_cache, nullptr);
    vk.vkDestroyCommandPool(device, command_pool, nullptr);
    vk.vkDestroySemaphore(device, timeline, nullptr);
    if (owned) vk.vkDestroyDevice(device, nullptr);
  }
  if (owned) destroyInstance(instance);
  device = VK_NULL_HANDLE;
}

std::uint64_t DeviceState::submit(VkCommandBuffer commands, VkSemaphore wait, VkSemaphore signal) {
  // What the device wrote becomes visible to mapped pointers.
  VkMemoryBarrier2 to_host{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  to_host.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  to_host.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  to_host.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
  to_host.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &to_host;
  vk.vkCmdPipelineBarrier2(commands, &dependency);
  check(vk.vkEndCommandBuffer(commands), "gpu", "vkEndCommandBuffer");

  VkSemaphoreSubmitInfo wait_info{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
  wait_info.semaphore = wait;
  wait_info.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  VkSemaphoreSubmitInfo signals[2] = {{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO},
                                      {VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO}};
  signals[0].semaphore = timeline;
  signals[0].value = submitted + 1;
  signals[0].stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  signals[1].semaphore = signal;
  signals[1].stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  VkCommandBufferSubmitInfo command_info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
  command_info.commandBuffer = commands;
  VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  info.waitSemaphoreInfoCount = wait != VK_NULL_HANDLE ? 1 : 0;
  info.pWaitSemaphoreInfos = &wait_info;
  info.commandBufferInfoCount = 1;
  info.pCommandBufferInfos = &command_info;
  info.signalSemaphoreInfoCount = signal != VK_NULL_HANDLE ? 2 : 1;
  info.pSignalSemaphoreInfos = signals;
  check(vk.vkQueueSubmit2(queue, 1, &info, VK_NULL_HANDLE), "gpu", "vkQueueSubmit2");
  return ++submitted;
}

void DeviceState::waitFor(std::uint64_t value) {
  VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
  info.semaphoreCount = 1;
  info.pSemaphores = &timeline;
  info.pValues = &value;
  check(vk.vkWaitSemaphores(device, &info, ~std::uint64_t{0}), "gpu", "waiting for the device");
}

std::uint64_t DeviceState::finishedValue() const {
  std::uint64_t value = 0;
  vk.vkGetSemaphoreCounterValue(device, timeline, &value);
  return value;
}

void DeviceState::retire(std::function<void()> destroy_one) {
  retired.emplace_back(submitted, std::move(destroy_one));
  collect();
}

void DeviceState::collect() {
  if (retired.empty()) return;
  const std::uint64_t finished = finishedValue();
  while (!retired.empty() && retired.front().first <= finished) {
    const auto destroy_one = std::move(retired.front().second);
    retired.pop_front();
    destroy_one();
  }
}

DeviceState::Allocation DeviceState::allocate(const std::string& name,
                                              const VkMemoryRequirements& requirements, MemoryKind kind,
                                              bool addressable) {
  constexpr VkMemoryPropertyFlags kMappable =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  // Best first; the last of each list is what is needed at least.
  std::vector<VkMemoryPropertyFlags> wishes;
  if (kind == MemoryKind::kDevice) wishes = {kLocal | kMappable | kCached, kLocal, 0};
  if (kind == MemoryKind::kHost) wishes = {kMappable | kCached, kMappable};
  if (kind == MemoryKind::kHostWrites) wishes = {kLocal | kMappable, kMappable};

  VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, addressable ? &flags : nullptr};
  info.allocationSize = requirements.size;
  for (const auto wish : wishes) {
    for (std::uint32_t i = 0; i < memory_properties.memoryTypeCount; ++i) {
      const VkMemoryPropertyFlags has = memory_properties.memoryTypes[i].propertyFlags;
      const VkDeviceSize heap =
          memory_properties.memoryHeaps[memory_properties.memoryTypes[i].heapIndex].size;
      if ((requirements.memoryTypeBits >> i & 1u) == 0 || (has & wish) != wish || requirements.size > heap)
        continue;
      info.memoryTypeIndex = i;
      Allocation allocation;
      if (vk.vkAllocateMemory(device, &info, nullptr, &allocation.memory) != VK_SUCCESS) continue;
      const bool map = kind == MemoryKind::kDevice ? (wish & kMappable) != 0 : true;
      void* mapped = nullptr;
      if (map) {
        const VkResult result = vk.vkMapMemory(device, allocation.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
        if (result != VK_SUCCESS) vk.vkFreeMemory(device, allocation.memory, nullptr);
        check(result, name, "vkMapMemory");
      }
      allocation.mapped = static_cast<std::byte*>(mapped);
      return allocation;
    }
  }
  throw Error(name, "needs " + mebibytes(requirements.size) + " of device memory, which '" + this->info.name +
                        "' does not have left");
}

VkSampler DeviceState::sampler(const Sampler& desc) {
  for (const auto& [known, handle] : samplers) {
    if (known == desc) return handle;
  }
  VkSamplerCreateInfo create{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  create.magFilter = create.minFilter = desc.filter;
  create.mipmapMode = desc.mip_filter;
  create.addressModeU = desc.wrap_u;
  create.addressModeV = desc.wrap_v;
  create.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  create.maxLod = VK_LOD_CLAMP_NONE;
  create.compareEnable = desc.compare != VK_COMPARE_OP_NEVER;
  create.compareOp = desc.compare;
  create.anisotropyEnable = features.sampler_anisotropy && desc.max_anisotropy > 1.0f;
  create.maxAnisotropy = desc.max_anisotropy;
  VkSampler handle = VK_NULL_HANDLE;
  check(vk.vkCreateSampler(device, &create, nullptr, &handle), "sampler", "vkCreateSampler");
  samplers.emplace_back(desc, handle);
  return handle;
}

void DeviceState::nameObject(VkObjectType type, std::uint64_t handle, const std::string& name) const {
  if (instance.functions.setObjectName == nullptr) return;
  VkDebugUtilsObjectNameInfoEXT named{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  named.objectType = type;
  named.objectHandle = handle;
  named.pObjectName = name.c_str();
  instance.functions.setObjectName(device, &named);
}

}  // namespace gloam::gpu
