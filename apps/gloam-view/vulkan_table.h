// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The Vulkan functions that the window calls, found at run time through GLFW: the program starts, and says what is missing,
// on machines without a Vulkan loader.
#pragma once

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan.h>

#include <gloam/error.h>

namespace gloam::view {

#define GLOAM_VIEW_INSTANCE_FUNCTIONS(X)     \
  X(DestroyInstance)                         \
  X(EnumeratePhysicalDevices)                \
  X(GetPhysicalDeviceProperties)             \
  X(GetPhysicalDeviceQueueFamilyProperties)  \
  X(GetPhysicalDeviceMemoryProperties)       \
  X(GetPhysicalDeviceSurfaceSupportKHR)      \
  X(GetPhysicalDeviceSurfaceCapabilitiesKHR) \
  X(GetPhysicalDeviceSurfaceFormatsKHR)      \
  X(GetPhysicalDeviceSurfacePresentModesKHR) \
  X(EnumerateDeviceExtensionProperties) X(DestroySurfaceKHR) X(CreateDevice) X(GetDeviceProcAddr)

#define GLOAM_VIEW_DEVICE_FUNCTIONS(X)                                                                      \
  X(DestroyDevice)                                                                                          \
  X(GetDeviceQueue)                                                                                         \
  X(DeviceWaitIdle)                                                                                         \
  X(QueueSubmit)                                                                                            \
  X(QueuePresentKHR)                                                                                        \
  X(CreateSwapchainKHR)                                                                                     \
  X(DestroySwapchainKHR)                                                                                    \
  X(GetSwapchainImagesKHR)                                                                                  \
  X(AcquireNextImageKHR)                                                                                    \
  X(CreateImage)                                                                                            \
  X(DestroyImage)                                                                                           \
  X(CreateImageView) X(DestroyImageView) X(GetImageMemoryRequirements) X(CreateBuffer) X(DestroyBuffer)     \
      X(GetBufferMemoryRequirements) X(AllocateMemory) X(FreeMemory) X(BindBufferMemory) X(BindImageMemory) \
          X(MapMemory) X(UnmapMemory) X(CreateCommandPool) X(DestroyCommandPool) X(AllocateCommandBuffers)  \
              X(BeginCommandBuffer) X(EndCommandBuffer) X(ResetCommandPool) X(CreateFence) X(DestroyFence)  \
                  X(WaitForFences) X(ResetFences) X(CreateSemaphore) X(DestroySemaphore) X(CreateSampler)   \
                      X(DestroySampler) X(CreateDescriptorSetLayout) X(DestroyDescriptorSetLayout)          \
                          X(CreateDescriptorPool) X(DestroyDescriptorPool) X(AllocateDescriptorSets)        \
                              X(FreeDescriptorSets) X(UpdateDescriptorSets) X(CreatePipelineLayout)         \
                                  X(DestroyPipelineLayout) X(CreateShaderModule) X(DestroyShaderModule)     \
                                      X(CreateGraphicsPipelines) X(DestroyPipeline) X(CreateQueryPool)      \
                                          X(DestroyQueryPool) X(GetQueryPoolResults) X(CmdResetQueryPool)   \
                                              X(CmdWriteTimestamp) X(CmdPipelineBarrier)                    \
                                                  X(CmdCopyBufferToImage) X(CmdCopyImageToBuffer)           \
                                                      X(CmdBeginRendering) X(CmdEndRendering)               \
                                                          X(CmdBindPipeline) X(CmdBindDescriptorSets)       \
                                                              X(CmdBindVertexBuffers) X(CmdBindIndexBuffer) \
                                                                  X(CmdPushConstants) X(CmdSetViewport)     \
                                                                      X(CmdSetScissor) X(CmdDrawIndexed)

struct VulkanTable {
#define GLOAM_VIEW_MEMBER(name) PFN_vk##name name = nullptr;
  GLOAM_VIEW_INSTANCE_FUNCTIONS(GLOAM_VIEW_MEMBER)
  GLOAM_VIEW_DEVICE_FUNCTIONS(GLOAM_VIEW_MEMBER)
#undef GLOAM_VIEW_MEMBER
};

/// What a call that must succeed gave. A lost device is told apart: the window is made anew then.
class DeviceLost : public Error {
 public:
  DeviceLost() : Error("window", "the Vulkan device was lost") {}
};
inline void check(VkResult result, const char* what) {
  if (result == VK_ERROR_DEVICE_LOST) throw DeviceLost();
  if (result < 0)
    throw Error("window", std::string(what) + " failed: VkResult " + std::to_string(int(result)));
}

}  // namespace gloam::view
