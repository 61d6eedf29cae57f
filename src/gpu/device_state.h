// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a Device holds. Only files of this room include this.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/program.h"

namespace gloam::gpu {

/// Throws Error(place, what failed and how) unless the result is VK_SUCCESS.
void check(VkResult result, const std::string& place, const char* what);

/// Functions of the instance. volk's global pointers are not used beyond creation, so that devices of different loaders
/// can live side by side.
struct InstanceFunctions {
  PFN_vkDestroyInstance destroyInstance = nullptr;
  PFN_vkEnumeratePhysicalDevices enumeratePhysicalDevices = nullptr;
  PFN_vkEnumerateDeviceExtensionProperties enumerateDeviceExtensionProperties = nullptr;
  PFN_vkGetPhysicalDeviceProperties2 getPhysicalDeviceProperties2 = nullptr;
  PFN_vkGetPhysicalDeviceFeatures2 getPhysicalDeviceFeatures2 = nullptr;
  PFN_vkGetPhysicalDeviceMemoryProperties getPhysicalDeviceMemoryProperties = nullptr;
  PFN_vkGetPhysicalDeviceQueueFamilyProperties getPhysicalDeviceQueueFamilyProperties = nullptr;
  PFN_vkGetPhysicalDeviceFormatProperties getPhysicalDeviceFormatProperties = nullptr;
  PFN_vkCreateDevice createDevice = nullptr;
  PFN_vkGetDeviceProcAddr getDeviceProcAddr = nullptr;
  PFN_vkCreateDebugUtilsMessengerEXT createMessenger =
      nullptr;  ///< null without VK_EXT_debug_utils, as all below
  PFN_vkDestroyDebugUtilsMessengerEXT destroyMessenger = nullptr;
  PFN_vkSetDebugUtilsObjectNameEXT setObjectName = nullptr;
  PFN_vkCmdBeginDebugUtilsLabelEXT beginLabel = nullptr;
  PFN_vkCmdEndDebugUtilsLabelEXT endLabel = nullptr;
};
InstanceFunctions loadInstanceFunctions(VkInstance instance, PFN_vkGetInstanceProcAddr get);

/// An instance with the validation layer and debug names where they are wanted and there.
struct Instance {
  VkInstance handle = VK_NULL_HANDLE;
  InstanceFunctions functions;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
};
/// Throws Error that names the package where there is no loader, driver or layer.
Instance createInstance(const std::vector<std::string>& extensions);
void destroyInstance(Instance& instance);

/// All optional and required features as the device has them; what is missing of the required ones.
struct FeatureChain {
  VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceShaderAtomicFloatFeaturesEXT atomic_float{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT};
  /// Links the structures; the extension's only where the device has it.
  void link(bool with_atomic_float);
};
struct Candidate {
  VkPhysicalDevice handle = VK_NULL_HANDLE;
  DeviceInfo info;
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  std::uint32_t queue_family = 0;
  bool has_atomic_float = false;
};
std::vector<Candidate> enumerateCandidates(const Instance& instance);
/// By index or part of the name; throws Error that lists what there is or names what is missing.
const Candidate& choose(const std::vector<Candidate>& candidates, const std::string& choice);
/// Creates the device with all that Features can name, as far as it is there.
VkDevice createDevice(const Instance& instance, const Candidate& candidate,
                      std::vector<std::string> extensions, Features& features);
Limits readLimits(const InstanceFunctions& functions, VkPhysicalDevice device, std::uint32_t queue_family);

enum class MemoryKind : std::uint8_t { kDevice, kHost, kHostWrites };

struct DeviceState {
  Instance instance;
  bool owned = false;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;
  VolkDeviceTable vk{};
  DeviceInfo info;
  Features features;
  Limits limits;
  VkPhysicalDeviceMemoryProperties memory_properties{};

  VkSemaphore timeline = VK_NULL_HANDLE;  ///< counts submissions
  std::uint64_t submitted = 0;
  VkCommandPool command_pool = VK_NULL_HANDLE;  ///< for runNow
  VkPipelineCache pipeline_cache = VK_NULL_HANDLE;

  std::map<const void*, MemoryUse> memory;  ///< by owner's handle
  std::vector<std::pair<Sampler, VkSampler>> samplers;
  std::map<std::vector<const std::uint32_t*>, std::unique_ptr<Program>> programs;
  std::deque<std::pair<std::uint64_t, std::function<void()>>> retired;

  void initialize();  ///< after device, queue and vk are set
  void destroy();

  /// Submits one command buffer; returns the value of the timeline that tells its end.
  std::uint64_t submit(VkCommandBuffer commands, VkSemaphore wait, VkSemaphore signal);
  void waitFor(std::uint64_t value);
  std::uint64_t finishedValue() const;
  /// Runs `destroy` when all that was submitted so far is done.
  void retire(std::function<void()> destroy);
  void collect();

  struct Allocation {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    std::byte* mapped =
        nullptr;  ///< where the memory is visible to the host, coherent, and cached if it is to be read
  };
  Allocation allocate(const std::string& name, const VkMemoryRequirements& requirements, MemoryKind kind,
                      bool addressable);
  VkSampler sampler(const Sampler& sampler);
  void nameObject(VkObjectType type, std::uint64_t handle, const std::string& name) const;
};

}  // namespace gloam::gpu
