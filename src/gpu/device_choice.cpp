// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Which device, and with which features.
#include <algorithm>
#include <cctype>
#include <cstring>

#include "gpu/device_state.h"

namespace gloam::gpu {
namespace {

struct Required {
  const char* name;
  VkBool32 (*value)(const FeatureChain&);
};
constexpr Required kRequired[] = {
    // For gl_PrimitiveID in fragment shaders, the triangle ids of the G-buffer.
    {"geometryShader", [](const FeatureChain& f) { return f.core.features.geometryShader; }},
    {"shaderStorageImageWriteWithoutFormat",
     [](const FeatureChain& f) { return f.core.features.shaderStorageImageWriteWithoutFormat; }},
    {"scalarBlockLayout", [](const FeatureChain& f) { return f.v12.scalarBlockLayout; }},
    {"timelineSemaphore", [](const FeatureChain& f) { return f.v12.timelineSemaphore; }},
    {"dynamicRendering", [](const FeatureChain& f) { return f.v13.dynamicRendering; }},
    {"synchronization2", [](const FeatureChain& f) { return f.v13.synchronization2; }},
    {"maintenance4", [](const FeatureChain& f) { return f.v13.maintenance4; }},
};

std::vector<VkQueueFamilyProperties> queueFamilies(const InstanceFunctions& functions,
                                                   VkPhysicalDevice device) {
  std::uint32_t count = 0;
  functions.getPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  functions.getPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  return families;
}

bool hasDeviceExtension(const InstanceFunctions& functions, VkPhysicalDevice device, const char* name) {
  std::uint32_t count = 0;
  functions.enumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  functions.enumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& extension) { return std::strcmp(extension.extensionName, name) == 0; });
}

std::string whatIsMissing(const InstanceFunctions& functions, const Candidate& candidate,
                          std::uint32_t version) {
  if (version < VK_API_VERSION_1_3) {
    return "Vulkan 1.3 (it has " + std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
           std::to_string(VK_API_VERSION_MINOR(version)) + ")";
  }
  if (candidate.queue_family == ~0u) return "a queue for both graphics and compute";
  FeatureChain chain;
  chain.link(candidate.has_atomic_float);
  functions.getPhysicalDeviceFeatures2(candidate.handle, &chain.core);
  std::string missing;
  for (const auto& required : kRequired) {
    if (!required.value(chain)) missing += (missing.empty() ? "" : ", ") + std::string(required.name);
  }
  return missing;
}

Candidate describe(const InstanceFunctions& functions, VkPhysicalDevice device, int index) {
  Candidate candidate;
  candidate.handle = device;
  VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
  functions.getPhysicalDeviceProperties2(device, &properties);
  candidate.type = properties.properties.deviceType;
  candidate.info.index = index;
  candidate.info.name = properties.properties.deviceName;
  candidate.info.driver = std::string(driver.driverName) + " " + driver.driverInfo;
  candidate.info.software = candidate.type == VK_PHYSICAL_DEVICE_TYPE_CPU;
  VkPhysicalDeviceMemoryProperties memory;
  functions.getPhysicalDeviceMemoryProperties(device, &memory);
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0) {
      candidate.info.memory_bytes =
          std::max<std::uint64_t>(candidate.info.memory_bytes, memory.memoryHeaps[i].size);
    }
  }
  candidate.queue_family = ~0u;
  const auto families = queueFamilies(functions, device);
  for (std::uint32_t i = 0; i < families.size() && candidate.queue_family == ~0u; ++i) {
    constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    if ((families[i].queueFlags & kBoth) == kBoth) candidate.queue_family = i;
  }
  candidate.has_atomic_float =
      hasDeviceExtension(functions, device, VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME);
  candidate.info.missing = whatIsMissing(functions, candidate, properties.properties.apiVersion);
  return candidate;
}

int rank(const Candidate& candidate) {
  switch (candidate.type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return 4;
    default:
      return 3;
  }
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string listed(const std::vector<Candidate>& candidates) {
  std::string text;
  for (const auto& candidate : candidates) {
    text += (text.empty() ? "" : ", ") + std::to_string(candidate.info.index) + " " + candidate.info.name;
  }
  return text;
}

}  // namespace

void FeatureChain::link(bool with_atomic_float) {
  core.pNext = &v11;
  v11.pNext = &v12;
  v12.pNext = &v13;
  v13.pNext = with_atomic_float ? &atomic_float : nullptr;
}

const std::vector<std::string>& Device::requiredFeatures() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const auto& required : kRequired) result.emplace_back(required.name);
    return result;
  }();
  return names;
}

std::vector<Candidate> enumerateCandidates(const Instance& instance) {
  std::uint32_t count = 0;
  instance.functions.enumeratePhysicalDevices(instance.handle, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  instance.functions.enumeratePhysicalDevices(instance.handle, &count, devices.data());
  std::vector<Candidate> candidates;
  for (std::uint32_t i = 0; i < count; ++i) {
    candidates.push_back(describe(instance.functions, devices[i], static_cast<int>(i)));
  }
  return candidates;
}

const Candidate& choose(const std::vector<Candidate>& candidates, const std::string& choice) {
  if (candidates.empty()) {
    throw Error("gpu",
                "no Vulkan device found; Debian's package mesa-vulkan-drivers brings a software driver");
  }
  std::vector<const Candidate*> matches;
  for (const auto& candidate : candidates) {
    if (choice.empty() || choice == std::to_string(candidate.info.index)) matches.push_back(&candidate);
  }
  const bool is_index = !matches.empty();  // an index wins over a number inside a name
  for (const auto& candidate : candidates) {
    if (!is_index && lower(candidate.info.name).find(lower(choice)) != std::string::npos) {
      matches.push_back(&candidate);
    }
  }
  if (matches.empty()) {
    throw Error("device '" + choice + "'",
                "no device has this index or name; there are: " + listed(candidates));
  }
  std::stable_sort(matches.begin(), matches.end(), [](const Candidate* a, const Candidate* b) {
    const auto key = [](const Candidate* c) { return std::pair(!c->info.missing.empty(), rank(*c)); };
    return key(a) < key(b);
  });
  const Candidate& best = *matches.front();
  if (!best.info.missing.empty()) {
    const std::string advice =
        choice.empty() ? "; Debian's package mesa-vulkan-drivers brings a software driver that has all" : "";
    throw Error("device '" + best.info.name + "'", "lacks " + best.info.missing + advice);
  }
  return best;
}

VkDevice createDevice(const Instance& instance, const Candidate& candidate,
                      std::vector<std::string> extensions, Features& features) {
  for (const auto& extension : extensions) {
    if (!hasDeviceExtension(instance.functions, candidate.handle, extension.c_str())) {
      throw Error("device '" + candidate.info.name + "'", "lacks the extension " + extension);
    }
  }
  FeatureChain has;
  has.link(candidate.has_atomic_float);
  instance.functions.getPhysicalDeviceFeatures2(candidate.handle, &has.core);

  FeatureChain wanted;
  wanted.link(candidate.has_atomic_float);
  auto& core = wanted.core.features;
  core.geometryShader = VK_TRUE;
  core.shaderStorageImageWriteWithoutFormat = VK_TRUE;
  core.fragmentStoresAndAtomics = has.core.features.fragmentStoresAndAtomics;
  core.vertexPipelineStoresAndAtomics = has.core.features.vertexPipelineStoresAndAtomics;
  core.samplerAnisotropy = has.core.features.samplerAnisotropy;
  core.depthClamp = has.core.features.depthClamp;
  core.imageCubeArray = has.core.features.imageCubeArray;
  core.fillModeNonSolid = has.core.features.fillModeNonSolid;
  core.shaderInt64 = has.core.features.shaderInt64;
  core.shaderInt16 = has.core.features.shaderInt16;
  wanted.v11.storageBuffer16BitAccess = has.v11.storageBuffer16BitAccess;
  wanted.v12.scalarBlockLayout = VK_TRUE;
  wanted.v12.timelineSemaphore = VK_TRUE;
  wanted.v12.shaderFloat16 = has.v12.shaderFloat16;
  wanted.v12.storageBuffer8BitAccess = has.v12.storageBuffer8BitAccess;
  wanted.v12.shaderInt8 = has.v12.shaderInt8;
  wanted.v12.bufferDeviceAddress = has.v12.bufferDeviceAddress;
  wanted.v13.dynamicRendering = VK_TRUE;
  wanted.v13.synchronization2 = VK_TRUE;
  wanted.v13.maintenance4 = VK_TRUE;
  wanted.atomic_float.shaderBufferFloat32AtomicAdd = has.atomic_float.shaderBufferFloat32AtomicAdd;
  wanted.atomic_float.shaderBufferFloat32Atomics = has.atomic_float.shaderBufferFloat32Atomics;
  features.float16 = wanted.v12.shaderFloat16;
  features.storage16 = wanted.v11.storageBuffer16BitAccess;
  features.buffer_device_address = wanted.v12.bufferDeviceAddress;
  features.float_atomics = candidate.has_atomic_float && wanted.atomic_float.shaderBufferFloat32AtomicAdd;
  features.sampler_anisotropy = core.samplerAnisotropy;
  features.depth_clamp = core.depthClamp;
  features.cube_arrays = core.imageCubeArray;
  features.wireframe = core.fillModeNonSolid;

  if (candidate.has_atomic_float) extensions.emplace_back(VK_EXT_SHADER_ATOMIC_FLOAT_EXTENSION_NAME);
  std::vector<const char*> names;
  for (const auto& extension : extensions) names.push_back(extension.c_str());
  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueFamilyIndex = candidate.queue_family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &wanted.core};
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
  info.ppEnabledExtensionNames = names.data();
  VkDevice device = VK_NULL_HANDLE;
  check(instance.functions.createDevice(candidate.handle, &info, nullptr, &device),
        "device '" + candidate.info.name + "'", "vkCreateDevice");
  return device;
}

Limits readLimits(const InstanceFunctions& functions, VkPhysicalDevice device, std::uint32_t queue_family) {
  VkPhysicalDeviceSubgroupProperties subgroup{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroup};
  functions.getPhysicalDeviceProperties2(device, &properties);
  const VkPhysicalDeviceLimits& from = properties.properties.limits;
  Limits limits;
  limits.max_storage_bytes = from.maxStorageBufferRange;
  limits.max_uniform_bytes = from.maxUniformBufferRange;
  limits.max_push_bytes = from.maxPushConstantsSize;
  limits.max_image_size = from.maxImageDimension2D;
  limits.max_shared_bytes = from.maxComputeSharedMemorySize;
  limits.subgroup_size = subgroup.subgroupSize;
  std::copy(std::begin(from.maxComputeWorkGroupCount), std::end(from.maxComputeWorkGroupCount),
            std::begin(limits.max_group_count));
  const auto families = queueFamilies(functions, device);
  if (queue_family < families.size() && families[queue_family].timestampValidBits > 0) {
    limits.timestamp_ns = from.timestampPeriod;
  }
  return limits;
}

}  // namespace gloam::gpu
