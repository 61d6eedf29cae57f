// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#define VOLK_IMPLEMENTATION
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "gpu/device_state.h"

namespace gloam::gpu {
namespace {

constexpr const char* kNoDriver =
    "no Vulkan driver found; Debian's package mesa-vulkan-drivers brings the software driver and those for "
    "Intel and "
    "AMD";
constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

std::atomic<std::uint64_t> message_count{0};

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
  ++message_count;
  const bool error = (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) != 0;
  std::fprintf(stderr, "vulkan validation: %s: %s\n", error ? "error" : "warning", data->pMessage);
  return VK_FALSE;
}

bool validationWanted() {
  const char* value = std::getenv("GLOAM_VALIDATION");
  return value != nullptr && *value != '\0' && std::strcmp(value, "0") != 0;
}

bool hasLayer(const char* name) {
  std::uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  for (const auto& layer : layers) {
    if (std::strcmp(layer.layerName, name) == 0) return true;
  }
  return false;
}

bool hasInstanceExtension(const char* layer, const char* name) {
  std::uint32_t count = 0;
  if (vkEnumerateInstanceExtensionProperties(layer, &count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data());
  for (const auto& extension : extensions) {
    if (std::strcmp(extension.extensionName, name) == 0) return true;
  }
  return false;
}

/// Once a process: volk finds the loader and its global functions.
bool loaderIsThere() {
  static const bool there = volkInitialize() == VK_SUCCESS;
  return there;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo() {
  VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
  info.messageType =
      VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  info.pfnUserCallback = onMessage;
  return info;
}

}  // namespace

std::uint64_t validationMessages() {
  return message_count;
}

void check(VkResult result, const std::string& place, const char* what) {
  if (result == VK_SUCCESS) return;
  const char* reason = nullptr;
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      reason = "out of host memory";
      break;
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      reason = "out of device memory";
      break;
    case VK_ERROR_DEVICE_LOST:
      reason = "the device was lost";
      break;
    case VK_ERROR_INITIALIZATION_FAILED:
      reason = "the driver could not be initialised";
      break;
    case VK_ERROR_EXTENSION_NOT_PRESENT:
      reason = "an extension is not there";
      break;
    case VK_ERROR_FEATURE_NOT_PRESENT:
      reason = "a feature is not there";
      break;
    default:
      break;
  }
  throw Error(place,
              std::string(what) + " failed: " +
                  (reason != nullptr ? reason : "VkResult " + std::to_string(static_cast<int>(result))));
}

InstanceFunctions loadInstanceFunctions(VkInstance instance, PFN_vkGetInstanceProcAddr get) {
  if (get == nullptr) {
    if (!loaderIsThere()) throw Error("gpu", kNoDriver);
    get = vkGetInstanceProcAddr;
  }
  InstanceFunctions f;
  const auto load = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(get(instance, name));
  };
  load(f.destroyInstance, "vkDestroyInstance");
  load(f.enumeratePhysicalDevices, "vkEnumeratePhysicalDevices");
  load(f.enumerateDeviceExtensionProperties, "vkEnumerateDeviceExtensionProperties");
  load(f.getPhysicalDeviceProperties2, "vkGetPhysicalDeviceProperties2");
  load(f.getPhysicalDeviceFeatures2, "vkGetPhysicalDeviceFeatures2");
  load(f.getPhysicalDeviceMemoryProperties, "vkGetPhysicalDeviceMemoryProperties");
  load(f.getPhysicalDeviceQueueFamilyProperties, "vkGetPhysicalDeviceQueueFamilyProperties");
  load(f.getPhysicalDeviceFormatProperties, "vkGetPhysicalDeviceFormatProperties");
  load(f.createDevice, "vkCreateDevice");
  load(f.getDeviceProcAddr, "vkGetDeviceProcAddr");
  load(f.createMessenger, "vkCreateDebugUtilsMessengerEXT");
  load(f.destroyMessenger, "vkDestroyDebugUtilsMessengerEXT");
  load(f.setObjectName, "vkSetDebugUtilsObjectNameEXT");
  load(f.beginLabel, "vkCmdBeginDebugUtilsLabelEXT");
  load(f.endLabel, "vkCmdEndDebugUtilsLabelEXT");
  return f;
}

Instance createInstance(const std::vector<std::string>& extensions) {
  if (!loaderIsThere()) throw Error("gpu", kNoDriver);
  if (vkEnumerateInstanceVersion == nullptr) throw Error("gpu", "the Vulkan loader is older than 1.1");
  const bool validation = validationWanted();
  if (validation && !hasLayer(kValidationLayer)) {
    throw Error("GLOAM_VALIDATION",
                "the validation layer is not installed; Debian's package is vulkan-validationlayers");
  }
  std::vector<const char*> names;
  for (const auto& extension : extensions) {
    if (!hasInstanceExtension(nullptr, extension.c_str())) {
      throw Error("gpu", "the Vulkan loader lacks the instance extension " + extension);
    }
    names.push_back(extension.c_str());
  }
  if (validation || hasInstanceExtension(nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME)) {
    names.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  }
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "gloam";
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  info.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
  info.ppEnabledExtensionNames = names.data();

  auto messenger = messengerInfo();
  // Missing barriers are what a frame graph gets wrong first: synchronisation is validated too.
  const VkValidationFeatureEnableEXT synchronization =
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  VkValidationFeaturesEXT validation_features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  validation_features.enabledValidationFeatureCount = 1;
  validation_features.pEnabledValidationFeatures = &synchronization;
  if (validation) {
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
    messenger.pNext = &validation_features;
    info.pNext = &messenger;
  }
  Instance instance;
  const VkResult result = vkCreateInstance(&info, nullptr, &instance.handle);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) throw Error("gpu", kNoDriver);
  check(result, "gpu", "vkCreateInstance");
  instance.functions = loadInstanceFunctions(instance.handle, vkGetInstanceProcAddr);
  if (validation) {
    messenger.pNext = nullptr;
    instance.functions.createMessenger(instance.handle, &messenger, nullptr, &instance.messenger);
  }
  return instance;
}

void destroyInstance(Instance& instance) {
  if (instance.handle == VK_NULL_HANDLE) return;
  if (instance.messenger != VK_NULL_HANDLE) {
    instance.functions.destroyMessenger(instance.handle, instance.messenger, nullptr);
  }
  instance.functions.destroyInstance(instance.handle, nullptr);
  instance.handle = VK_NULL_HANDLE;
}

}  // namespace gloam::gpu
