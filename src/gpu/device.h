// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/error.h>
#include <volk.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/sampler.h"
#include "gpu/shader_code.h"

namespace gloam::gpu {

class Program;
struct DeviceState;

/// What may or may not be there. The picture is the same either way.
struct Features {
  bool float16 = false;                ///< half arithmetic in shaders
  bool storage16 = false;              ///< 16-bit values in storage buffers
  bool buffer_device_address = false;  ///< storage beyond max_storage_bytes through pointers
  bool float_atomics = false;          ///< atomicAdd on floats in buffers
  bool sampler_anisotropy = false;
  bool depth_clamp = false;
  bool cube_arrays = false;
  bool wireframe = false;
};

struct Limits {
  std::uint64_t max_storage_bytes = 0;  ///< one storage buffer binding: 128 MiB on Mesa's software driver
  std::uint64_t max_uniform_bytes = 0;
  std::uint32_t max_push_bytes = 128;
  std::uint32_t max_image_size = 0;
  std::uint32_t max_group_count[3] = {};
  std::uint32_t max_shared_bytes = 0;  ///< shared memory of a work group
  std::uint32_t subgroup_size = 0;
  double timestamp_ns = 0.0;  ///< a tick of the GPU clock; 0: no timestamps, GPU times read 0
};

struct DeviceInfo {
  int index = 0;       ///< as `--device 0` takes it
  std::string name;    ///< as `--device llvmpipe` takes a part of it
  std::string driver;  ///< driver and version
  bool software = false;
  std::uint64_t memory_bytes = 0;  ///< of the largest device-local heap
  std::string missing;  ///< why it cannot be used ("Vulkan 1.3", "scalarBlockLayout"); empty: it can
};

struct DeviceOptions {
  std::string
      choice;  ///< index or part of a name, case ignored; empty: the first suitable one, GPUs before software
  /// What a window needs besides; rendering needs none.
  std::vector<std::string> instance_extensions, device_extensions;
};

/// A host engine's device. The host keeps owning all of it and outlives what is made from it. It enabled
/// Vulkan 1.3 and the features that requiredFeatures() lists; what else it enabled it says in `features`.
struct HostDevice {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;  ///< graphics and compute; used only inside calls of this library
  std::uint32_t queue_family = 0;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;  ///< null: that of the system's loader
  Features features;
};

struct MemoryUse {
  std::string name;
  std::uint64_t bytes = 0;
};

/// A Vulkan 1.3 device with one queue for graphics, compute and transfer. One thread at a time uses a device
/// and what was made from it. GLOAM_VALIDATION=1 in the environment turns the Khronos validation layer on.
class Device {
 public:
  /// Throws Error that names what is missing and the package that brings it.
  static std::unique_ptr<Device> create(const DeviceOptions& options = {});
  static std::unique_ptr<Device> adopt(const HostDevice& host);
  /// All devices of the system, suitable or not; empty without a driver or loader. Never throws Error.
  static std::vector<DeviceInfo> list();
  /// Names of the features that a host's device must have enabled.
  static const std::vector<std::string>& requiredFeatures();

  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const;
  const Features& features() const;
  const Limits& limits() const;

  const VolkDeviceTable& vk() const;
  VkDevice handle() const;
  VkInstance instance() const;
  VkPhysicalDevice physicalDevice() const;
  VkQueue queue() const;
  std::uint32_t queueFamily() const;

  /// Every live resource with its memory, by name; the sum.
  std::vector<MemoryUse> memory() const;
  std::uint64_t memoryBytes() const;

  /// Records commands, submits them and waits until they are done: for uploads, not for frames.
  void runNow(const std::function<void(VkCommandBuffer)>& record);
  /// Waits for all that was submitted through this device.
  void wait();

  // ---- For the files of this room
  // ----------------------------------------------------------------------------------
  DeviceState& state() { return *state_; }

 private:
  explicit Device(std::unique_ptr<DeviceState> state);
  std::unique_ptr<DeviceState> state_;
};

/// Messages of the validation layer since the process began, each of which was also printed to stderr. Stays
/// after devices are gone, so that what a device leaves behind is counted too.
std::uint64_t validationMessages();

}  // namespace gloam::gpu
