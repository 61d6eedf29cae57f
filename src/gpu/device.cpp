// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/device.h"

#include <mutex>

#include "gpu/device_state.h"

namespace gloam::gpu {
namespace {

/// volk reads the table through a global pointer.
void loadTable(DeviceState& state) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  vkGetDeviceProcAddr = state.instance.functions.getDeviceProcAddr;
  volkLoadDeviceTable(&state.vk, state.device);
}

}  // namespace

std::unique_ptr<Device> Device::create(const DeviceOptions& options) {
  auto state = std::make_unique<DeviceState>();
  state->owned = true;
  state->instance = createInstance(options.instance_extensions);
  try {
    const auto candidates = enumerateCandidates(state->instance);
    const Candidate& chosen = choose(candidates, options.choice);
    state->info = chosen.info;
    state->physical_device = chosen.handle;
    state->queue_family = chosen.queue_family;
    state->device = createDevice(state->instance, chosen, options.device_extensions, state->features);
    loadTable(*state);
    state->vk.vkGetDeviceQueue(state->device, state->queue_family, 0, &state->queue);
    state->initialize();
  } catch (...) {
    state->destroy();
    throw;
  }
  return std::unique_ptr<Device>(new Device(std::move(state)));
}

std::unique_ptr<Device> Device::adopt(const HostDevice& host) {
  if (host.instance == VK_NULL_HANDLE || host.physical_device == VK_NULL_HANDLE ||
      host.device == VK_NULL_HANDLE || host.queue == VK_NULL_HANDLE) {
    throw Error("gpu",
                "a host's device needs instance, physical_device, device and queue; one of them is null");
  }
  auto state = std::make_unique<DeviceState>();
  state->instance.handle = host.instance;
  state->instance.functions = loadInstanceFunctions(host.instance, host.get_instance_proc_addr);
  for (const auto& candidate : enumerateCandidates(state->instance)) {
    if (candidate.handle == host.physical_device) state->info = candidate.info;
  }
  if (!state->info.missing.empty()) {
    throw Error("device '" + state->info.name + "'", "lacks " + state->info.missing);
  }
  state->physical_device = host.physical_device;
  state->device = host.device;
  state->queue = host.queue;
  state->queue_family = host.queue_family;
  state->features = host.features;
  loadTable(*state);
  try {
    state->initialize();
  } catch (...) {
    state->destroy();
    throw;
  }
  return std::unique_ptr<Device>(new Device(std::move(state)));
}

std::vector<DeviceInfo> Device::list() {
  std::vector<DeviceInfo> infos;
  Instance instance;
  try {
    instance = createInstance({});
  } catch (const Error&) {
    return infos;
  }
  for (const auto& candidate : enumerateCandidates(instance)) infos.push_back(candidate.info);
  destroyInstance(instance);
  return infos;
}

Device::Device(std::unique_ptr<DeviceState> state) : state_(std::move(state)) {}
Device::~Device() {
  state_->destroy();
}

const DeviceInfo& Device::info() const {
  return state_->info;
}
const Features& Device::features() const {
  return state_->features;
}
const Limits& Device::limits() const {
  return state_->limits;
}
const VolkDeviceTable& Device::vk() const {
  return state_->vk;
}
VkDevice Device::handle() const {
  return state_->device;
}
VkInstance Device::instance() const {
  return state_->instance.handle;
}
VkPhysicalDevice Device::physicalDevice() const {
  return state_->physical_device;
}
VkQueue Device::queue() const {
  return state_->queue;
}
std::uint32_t Device::queueFamily() const {
  return state_->queue_family;
}

std::vector<MemoryUse> Device::memory() const {
  std::vector<MemoryUse> uses;
  for (const auto& [owner, use] : state_->memory) uses.push_back(use);
  return uses;
}

std::uint64_t Device::memoryBytes() const {
  std::uint64_t sum = 0;
  for (const auto& [owner, use] : state_->memory) sum += use.bytes;
  return sum;
}

void Device::runNow(const std::function<void(VkCommandBuffer)>& record) {
  DeviceState& state = *state_;
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = state.command_pool;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(state.vk.vkAllocateCommandBuffers(state.device, &info, &commands), "gpu", "vkAllocateCommandBuffers");
  const auto free = [&] { state.vk.vkFreeCommandBuffers(state.device, state.command_pool, 1, &commands); };
  try {
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(state.vk.vkBeginCommandBuffer(commands, &begin), "gpu", "vkBeginCommandBuffer");
    record(commands);
    state.waitFor(state.submit(commands, VK_NULL_HANDLE, VK_NULL_HANDLE));
  } catch (...) {
    free();
    throw;
  }
  free();
  state.collect();
}

void Device::wait() {
  state_->waitFor(state_->submitted);
  state_->collect();
}

}  // namespace gloam::gpu
