// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The window's own Vulkan device. Pictures come from gloam's renderer as pixels, so the two devices share nothing.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "vulkan_table.h"

struct GLFWwindow;

namespace gloam::view {

class WindowDevice {
 public:
  /// Throws Error that says what is missing: a loader, a driver, one that can present to this window.
  explicit WindowDevice(GLFWwindow* window);
  ~WindowDevice();
  WindowDevice(const WindowDevice&) = delete;
  WindowDevice& operator=(const WindowDevice&) = delete;

  const VulkanTable& vk() const { return vk_; }
  VkPhysicalDevice physicalDevice() const { return physical_; }
  VkDevice handle() const { return device_; }
  VkQueue queue() const { return queue_; }
  std::uint32_t queueFamily() const { return family_; }
  VkSurfaceKHR surface() const { return surface_; }
  double timestampNs() const { return timestamp_ns_; }  ///< a tick; 0: no timestamps
  const std::string& name() const { return name_; }
  bool software() const { return software_; }  ///< the host's own cores draw

  struct Buffer {
    VkBuffer handle = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    void* mapped = nullptr;
    std::size_t bytes = 0;
  };
  /// Host-visible and mapped.
  Buffer createBuffer(std::size_t bytes, VkBufferUsageFlags usage) const;
  void destroy(Buffer& buffer) const;

  struct Image {
    VkImage handle = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    int width = 0, height = 0;
  };
  /// RGBA, 8 bits, to be sampled.
  Image createImage(int width, int height) const;
  void destroy(Image& image) const;

  /// Images, buffers and views alive: what a test of leaks counts.
  int liveObjects() const { return live_; }

 private:
  void createInstance();
  void chooseDevice();
  void createDevice();
  void release();
  std::uint32_t memoryType(std::uint32_t bits, VkMemoryPropertyFlags wanted) const;

  VulkanTable vk_;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  std::uint32_t family_ = 0;
  double timestamp_ns_ = 0.0;
  std::string name_;
  bool software_ = false;
  mutable int live_ = 0;
};

/// Moves a colour image of one level and layer from one layout to another, between the stages and accesses given.
void moveLayout(const VulkanTable& vk, VkCommandBuffer commands, VkImage image, VkImageLayout from,
                VkImageLayout to, VkAccessFlags before, VkAccessFlags after, VkPipelineStageFlags source,
                VkPipelineStageFlags target);

/// Messages of the validation layer about the window, since the process began (GLOAM_VALIDATION=1).
int windowValidationMessages();

}  // namespace gloam::view
