// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "window_device.h"

#include <GLFW/glfw3.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace gloam::view {
namespace {

constexpr const char* kNoDriver =
    "no Vulkan driver found; Debian's package mesa-vulkan-drivers brings the software driver and those for "
    "Intel and AMD";
std::atomic<int> messages{0};

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
  ++messages;
  std::fprintf(stderr, "vulkan validation: window: %s\n", data->pMessage);
  return VK_FALSE;
}

bool validationWanted() {
  const char* value = std::getenv("GLOAM_VALIDATION");
  return value != nullptr && *value != '\0' && std::strcmp(value, "0") != 0;
}

template <class Function>
Function globalFunction(const char* name) {
  return reinterpret_cast<Function>(glfwGetInstanceProcAddress(nullptr, name));
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo() {
  VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = onMessage;
  return info;
}

}  // namespace

int windowValidationMessages() {
  return messages;
}

WindowDevice::WindowDevice(GLFWwindow* window) {
  if (glfwVulkanSupported() == GLFW_FALSE) throw Error("window", kNoDriver);
  try {
    createInstance();
    if (glfwCreateWindowSurface(instance_, window, nullptr, &surface_) != VK_SUCCESS) {
      throw Error("window", "the Vulkan driver cannot draw into windows here");
    }
    chooseDevice();
    createDevice();
  } catch (...) {
    release();
    throw;
  }
}

WindowDevice::~WindowDevice() {
  release();
}

void WindowDevice::release() {
  if (device_ != VK_NULL_HANDLE) vk_.DestroyDevice(device_, nullptr);
  if (surface_ != VK_NULL_HANDLE) vk_.DestroySurfaceKHR(instance_, surface_, nullptr);
  if (messenger_ != VK_NULL_HANDLE) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        glfwGetInstanceProcAddress(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance_, messenger_, nullptr);
  }
  if (instance_ != VK_NULL_HANDLE) vk_.DestroyInstance(instance_, nullptr);
}

void WindowDevice::createInstance() {
  std::uint32_t count = 0;
  const char** needed = glfwGetRequiredInstanceExtensions(&count);
  if (needed == nullptr) throw Error("window", kNoDriver);  // no driver that knows this display
  std::vector<const char*> extensions(needed, needed + count);
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "gloam-view";
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  const char* layer = "VK_LAYER_KHRONOS_validation";
  VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo();
  if (validationWanted()) {
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &layer;
    info.pNext = &messenger;
  }
  info.enabledExtensionCount = std::uint32_t(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  const VkResult result =
      globalFunction<PFN_vkCreateInstance>("vkCreateInstance")(&info, nullptr, &instance_);
  if (result == VK_ERROR_LAYER_NOT_PRESENT) {
    throw Error("GLOAM_VALIDATION",
                "the validation layer is not installed; Debian's package is vulkan-validationlayers");
  }
  if (result != VK_SUCCESS) throw Error("window", kNoDriver);
#define GLOAM_VIEW_LOAD(name) \
  vk_.name = reinterpret_cast<PFN_vk##name>(glfwGetInstanceProcAddress(instance_, "vk" #name));
  GLOAM_VIEW_INSTANCE_FUNCTIONS(GLOAM_VIEW_LOAD)
#undef GLOAM_VIEW_LOAD
  if (!validationWanted()) return;
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      glfwGetInstanceProcAddress(instance_, "vkCreateDebugUtilsMessengerEXT"));
  create(instance_, &messenger, nullptr, &messenger_);
}

/// The first Vulkan 1.3 device that shows pictures in this window; real GPUs before software.
void WindowDevice::chooseDevice() {
  std::uint32_t count = 0;
  vk_.EnumeratePhysicalDevices(instance_, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  vk_.EnumeratePhysicalDevices(instance_, &count, devices.data());
  int best = -1;
  for (const VkPhysicalDevice device : devices) {
    VkPhysicalDeviceProperties properties;
    vk_.GetPhysicalDeviceProperties(device, &properties);
    if (properties.apiVersion < VK_API_VERSION_1_3) continue;
    std::uint32_t families = 0;
    vk_.GetPhysicalDeviceQueueFamilyProperties(device, &families, nullptr);
    std::vector<VkQueueFamilyProperties> queues(families);
    vk_.GetPhysicalDeviceQueueFamilyProperties(device, &families, queues.data());
    for (std::uint32_t i = 0; i < families; ++i) {
      VkBool32 presents = VK_FALSE;
      vk_.GetPhysicalDeviceSurfaceSupportKHR(device, i, surface_, &presents);
      if (presents == VK_FALSE || (queues[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) continue;
      const int worth = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU     ? 3
                        : properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU ? 2
                                                                                          : 1;
      if (worth <= best) continue;
      best = worth;
      physical_ = device;
      family_ = i;
      name_ = properties.deviceName;
      software_ = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
      timestamp_ns_ = queues[i].timestampValidBits > 0 ? double(properties.limits.timestampPeriod) : 0.0;
    }
  }
  if (best < 0)
    throw Error("window", devices.empty() ? kNoDriver : "no Vulkan 1.3 device draws into windows here");
}

void WindowDevice::createDevice() {
  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueFamilyIndex = family_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  const char* extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  VkPhysicalDeviceVulkan13Features features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  features.dynamicRendering = VK_TRUE;
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  info.pNext = &features;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = 1;
  info.ppEnabledExtensionNames = &extension;
  check(vk_.CreateDevice(physical_, &info, nullptr, &device_), "vkCreateDevice");
#define GLOAM_VIEW_LOAD(name) \
  vk_.name = reinterpret_cast<PFN_vk##name>(vk_.GetDeviceProcAddr(device_, "vk" #name));
  GLOAM_VIEW_DEVICE_FUNCTIONS(GLOAM_VIEW_LOAD)
#undef GLOAM_VIEW_LOAD
  vk_.GetDeviceQueue(device_, family_, 0, &queue_);
}

std::uint32_t WindowDevice::memoryType(std::uint32_t bits, VkMemoryPropertyFlags wanted) const {
  VkPhysicalDeviceMemoryProperties memory;
  vk_.GetPhysicalDeviceMemoryProperties(physical_, &memory);
  for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    if ((bits & (1u << i)) != 0 && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  }
  throw Error("window", "the device has no memory of the kind that is needed");
}

WindowDevice::Buffer WindowDevice::createBuffer(std::size_t bytes, VkBufferUsageFlags usage) const {
  Buffer buffer;
  buffer.bytes = bytes;
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes;
  info.usage = usage;
  check(vk_.CreateBuffer(device_, &info, nullptr, &buffer.handle), "vkCreateBuffer");
  VkMemoryRequirements needs;
  vk_.GetBufferMemoryRequirements(device_, buffer.handle, &needs);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = memoryType(
      needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  check(vk_.AllocateMemory(device_, &allocate, nullptr, &buffer.memory), "vkAllocateMemory");
  check(vk_.BindBufferMemory(device_, buffer.handle, buffer.memory, 0), "vkBindBufferMemory");
  check(vk_.MapMemory(device_, buffer.memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped), "vkMapMemory");
  ++live_;
  return buffer;
}

void WindowDevice::destroy(Buffer& buffer) const {
  if (buffer.handle == VK_NULL_HANDLE) return;
  vk_.DestroyBuffer(device_, buffer.handle, nullptr);
  vk_.FreeMemory(device_, buffer.memory, nullptr);
  buffer = {};
  --live_;
}

WindowDevice::Image WindowDevice::createImage(int width, int height) const {
  Image image;
  image.width = width;
  image.height = height;
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.extent = {std::uint32_t(width), std::uint32_t(height), 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  check(vk_.CreateImage(device_, &info, nullptr, &image.handle), "vkCreateImage");
  VkMemoryRequirements needs;
  vk_.GetImageMemoryRequirements(device_, image.handle, &needs);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = memoryType(needs.memoryTypeBits, 0);
  check(vk_.AllocateMemory(device_, &allocate, nullptr, &image.memory), "vkAllocateMemory");
  check(vk_.BindImageMemory(device_, image.handle, image.memory, 0), "vkBindImageMemory");
  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = image.handle;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = info.format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  check(vk_.CreateImageView(device_, &view, nullptr, &image.view), "vkCreateImageView");
  ++live_;
  return image;
}

void WindowDevice::destroy(Image& image) const {
  if (image.handle == VK_NULL_HANDLE) return;
  vk_.DestroyImageView(device_, image.view, nullptr);
  vk_.DestroyImage(device_, image.handle, nullptr);
  vk_.FreeMemory(device_, image.memory, nullptr);
  image = {};
  --live_;
}

void moveLayout(const VulkanTable& vk, VkCommandBuffer commands, VkImage image, VkImageLayout from,
                VkImageLayout to, VkAccessFlags before, VkAccessFlags after, VkPipelineStageFlags source,
                VkPipelineStageFlags target) {
  VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  barrier.srcAccessMask = before;
  barrier.dstAccessMask = after;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  vk.CmdPipelineBarrier(commands, source, target, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

}  // namespace gloam::view
