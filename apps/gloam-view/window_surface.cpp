// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "window_surface.h"

#include <algorithm>
#include <cmath>

namespace gloam::view {
namespace {

constexpr std::uint64_t kForever = ~std::uint64_t(0);

float srgbDecode(float signal) {
  return signal <= 0.04045f ? signal / 12.92f : std::pow((signal + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

WindowSurface::WindowSurface(const WindowDevice& device, bool vsync) : device_(device), vsync_(vsync) {
  const VulkanTable& vk = device.vk();
  std::uint32_t count = 0;
  vk.GetPhysicalDeviceSurfaceFormatsKHR(device.physicalDevice(), device.surface(), &count, nullptr);
  std::vector<VkSurfaceFormatKHR> formats(count);
  vk.GetPhysicalDeviceSurfaceFormatsKHR(device.physicalDevice(), device.surface(), &count, formats.data());
  for (const VkSurfaceFormatKHR& f : formats) {  // values are encoded already: no sRGB format
    if (f.format != VK_FORMAT_B8G8R8A8_UNORM && f.format != VK_FORMAT_R8G8B8A8_UNORM) continue;
    format_ = f.format;
    color_space_ = f.colorSpace;
    break;
  }
  if (format_ == VK_FORMAT_UNDEFINED) throw Error("window", "the display takes no 8-bit RGBA");
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.queueFamilyIndex = device.queueFamily();
  check(vk.CreateCommandPool(device.handle(), &pool, nullptr, &command_pool_), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = command_pool_;
  allocate.commandBufferCount = 1;
  check(vk.AllocateCommandBuffers(device.handle(), &allocate, &commands_), "vkAllocateCommandBuffers");
  VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  check(vk.CreateFence(device.handle(), &fence, nullptr, &fence_), "vkCreateFence");
  VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  check(vk.CreateSemaphore(device.handle(), &semaphore, nullptr, &acquired_), "vkCreateSemaphore");
  VkQueryPoolCreateInfo times{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  times.queryType = VK_QUERY_TYPE_TIMESTAMP;
  times.queryCount = 2;
  check(vk.CreateQueryPool(device.handle(), &times, nullptr, &times_), "vkCreateQueryPool");
  ui_ = std::make_unique<UiRenderer>(device, format_);
}

WindowSurface::~WindowSurface() {
  const VulkanTable& vk = device_.vk();
  vk.DeviceWaitIdle(device_.handle());
  ui_.reset();
  device_.destroy(capture_);
  destroyImages();
  if (swapchain_ != VK_NULL_HANDLE) vk.DestroySwapchainKHR(device_.handle(), swapchain_, nullptr);
  vk.DestroyQueryPool(device_.handle(), times_, nullptr);
  vk.DestroySemaphore(device_.handle(), acquired_, nullptr);
  vk.DestroyFence(device_.handle(), fence_, nullptr);
  vk.DestroyCommandPool(device_.handle(), command_pool_, nullptr);
}

void WindowSurface::destroyImages() {
  const VulkanTable& vk = device_.vk();
  for (const VkImageView view : views_) vk.DestroyImageView(device_.handle(), view, nullptr);
  for (const VkSemaphore semaphore : drawn_) vk.DestroySemaphore(device_.handle(), semaphore, nullptr);
  views_.clear();
  drawn_.clear();
  images_.clear();
}

void WindowSurface::setVsync(bool vsync) {
  stale_ |= vsync != vsync_;
  vsync_ = vsync;
}

void WindowSurface::create(int width, int height) {
  const VulkanTable& vk = device_.vk();
  check(vk.DeviceWaitIdle(device_.handle()), "vkDeviceWaitIdle");
  in_flight_ = false;
  destroyImages();
  VkSurfaceCapabilitiesKHR can;
  check(vk.GetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physicalDevice(), device_.surface(), &can),
        "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
  VkExtent2D extent = can.currentExtent;
  if (extent.width == ~0u) {
    extent = {std::clamp(std::uint32_t(width), can.minImageExtent.width, can.maxImageExtent.width),
              std::clamp(std::uint32_t(height), can.minImageExtent.height, can.maxImageExtent.height)};
  }
  width_ = int(extent.width);
  height_ = int(extent.height);
  VkSwapchainKHR old = swapchain_;
  swapchain_ = VK_NULL_HANDLE;
  if (width_ == 0 || height_ == 0) {
    if (old != VK_NULL_HANDLE) vk.DestroySwapchainKHR(device_.handle(), old, nullptr);
    return;
  }
  std::uint32_t count = 0;
  vk.GetPhysicalDeviceSurfacePresentModesKHR(device_.physicalDevice(), device_.surface(), &count, nullptr);
  std::vector<VkPresentModeKHR> modes(count);
  vk.GetPhysicalDeviceSurfacePresentModesKHR(device_.physicalDevice(), device_.surface(), &count,
                                             modes.data());
  VkPresentModeKHR mode = VK_PRESENT_MODE_FIFO_KHR;
  if (!vsync_) {
    for (const VkPresentModeKHR m : {VK_PRESENT_MODE_IMMEDIATE_KHR, VK_PRESENT_MODE_MAILBOX_KHR}) {
      if (std::ranges::find(modes, m) != modes.end()) mode = m;
    }
  }
  captures_ = (can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT) != 0;
  VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
  info.surface = device_.surface();
  info.minImageCount =
      can.maxImageCount == 0 ? can.minImageCount + 1 : std::min(can.minImageCount + 1, can.maxImageCount);
  info.imageFormat = format_;
  info.imageColorSpace = color_space_;
  info.imageExtent = extent;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                    (captures_ ? VkImageUsageFlags(VK_IMAGE_USAGE_TRANSFER_SRC_BIT) : 0u);
  info.preTransform = can.currentTransform;
  info.compositeAlpha = (can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0
                            ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                            : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
  info.presentMode = mode;
  info.clipped = VK_TRUE;
  info.oldSwapchain = old;
  const VkResult result = vk.CreateSwapchainKHR(device_.handle(), &info, nullptr, &swapchain_);
  if (old != VK_NULL_HANDLE) vk.DestroySwapchainKHR(device_.handle(), old, nullptr);
  check(result, "vkCreateSwapchainKHR");
  check(vk.GetSwapchainImagesKHR(device_.handle(), swapchain_, &count, nullptr), "vkGetSwapchainImagesKHR");
  images_.resize(count);
  check(vk.GetSwapchainImagesKHR(device_.handle(), swapchain_, &count, images_.data()),
        "vkGetSwapchainImagesKHR");
  for (const VkImage image : images_) {
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format_;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    check(vk.CreateImageView(device_.handle(), &view, nullptr, &views_.emplace_back()), "vkCreateImageView");
    VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    check(vk.CreateSemaphore(device_.handle(), &semaphore, nullptr, &drawn_.emplace_back()),
          "vkCreateSemaphore");
  }
  stale_ = false;
}

void WindowSurface::wait() {
  if (!in_flight_) return;
  const VulkanTable& vk = device_.vk();
  check(vk.WaitForFences(device_.handle(), 1, &fence_, VK_TRUE, kForever), "vkWaitForFences");
  in_flight_ = false;
  readTimes();
  if (reads_) readCapture();
}

bool WindowSurface::show(int width, int height, const ImDrawData& data) {
  if (width <= 0 || height <= 0) return false;
  wait();
  const VulkanTable& vk = device_.vk();
  if (stale_ || width != width_ || height != height_) create(width, height);
  if (swapchain_ == VK_NULL_HANDLE) return false;
  std::uint32_t index = 0;
  const VkResult acquired =
      vk.AcquireNextImageKHR(device_.handle(), swapchain_, kForever, acquired_, VK_NULL_HANDLE, &index);
  if (acquired == VK_ERROR_OUT_OF_DATE_KHR) {
    stale_ = true;
    return false;
  }
  check(acquired, "vkAcquireNextImageKHR");
  record(index, data);
  const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.waitSemaphoreCount = submit.commandBufferCount = submit.signalSemaphoreCount = 1;
  submit.pWaitSemaphores = &acquired_;
  submit.pWaitDstStageMask = &stage;
  submit.pCommandBuffers = &commands_;
  submit.pSignalSemaphores = &drawn_[index];
  check(vk.ResetFences(device_.handle(), 1, &fence_), "vkResetFences");
  check(vk.QueueSubmit(device_.queue(), 1, &submit, fence_), "vkQueueSubmit");
  in_flight_ = true;
  VkPresentInfoKHR present{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
  present.waitSemaphoreCount = present.swapchainCount = 1;
  present.pWaitSemaphores = &drawn_[index];
  present.pSwapchains = &swapchain_;
  present.pImageIndices = &index;
  const VkResult presented = vk.QueuePresentKHR(device_.queue(), &present);
  stale_ = presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_SUBOPTIMAL_KHR ||
           acquired == VK_SUBOPTIMAL_KHR;
  if (presented != VK_ERROR_OUT_OF_DATE_KHR) check(presented, "vkQueuePresentKHR");
  return true;
}

void WindowSurface::record(std::uint32_t index, const ImDrawData& data) {
  const VulkanTable& vk = device_.vk();
  check(vk.ResetCommandPool(device_.handle(), command_pool_, 0), "vkResetCommandPool");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vk.BeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
  vk.CmdResetQueryPool(commands_, times_, 0, 2);
  vk.CmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, times_, 0);
  ui_->recordUploads(commands_);
  moveLayout(vk, commands_, images_[index], VK_IMAGE_LAYOUT_UNDEFINED,
             VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, 0, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
             VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT);
  VkRenderingAttachmentInfo attachment{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  attachment.imageView = views_[index];
  attachment.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.clearValue.color = {{0.055f, 0.06f, 0.068f, 1.0f}};
  VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
  rendering.renderArea.extent = {std::uint32_t(width_), std::uint32_t(height_)};
  rendering.layerCount = rendering.colorAttachmentCount = 1;
  rendering.pColorAttachments = &attachment;
  vk.CmdBeginRendering(commands_, &rendering);
  const bool fits = data.DisplaySize.x * data.FramebufferScale.x <= float(width_) + 0.5f &&
                    data.DisplaySize.y * data.FramebufferScale.y <= float(height_) + 0.5f;
  if (fits) ui_->record(commands_, data);
  vk.CmdEndRendering(commands_);
  const bool copies = std::exchange(capture_wanted_, false) && captures_;
  if (copies) {
    moveLayout(vk, commands_, images_[index], VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
               VK_ACCESS_TRANSFER_READ_BIT, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
               VK_PIPELINE_STAGE_TRANSFER_BIT);
    recordCopy(images_[index]);
  }
  moveLayout(vk, commands_, images_[index],
             copies ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
             VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
             copies ? 0u : VkAccessFlags(VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT), 0,
             copies ? VK_PIPELINE_STAGE_TRANSFER_BIT : VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
             VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT);
  vk.CmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, times_, 1);
  check(vk.EndCommandBuffer(commands_), "vkEndCommandBuffer");
}

void WindowSurface::recordCopy(VkImage image) {
  const std::size_t bytes = std::size_t(width_) * std::size_t(height_) * 4;
  if (capture_.bytes < bytes) {
    device_.destroy(capture_);
    capture_ = device_.createBuffer(bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  }
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {std::uint32_t(width_), std::uint32_t(height_), 1};
  device_.vk().CmdCopyImageToBuffer(commands_, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, capture_.handle,
                                    1, &copy);
  VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
  device_.vk().CmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                                  &barrier, 0, nullptr, 0, nullptr);
  reads_ = true;
}

void WindowSurface::readTimes() {
  std::uint64_t ticks[2] = {};
  const VkResult result = device_.vk().GetQueryPoolResults(device_.handle(), times_, 0, 2, sizeof ticks,
                                                           ticks, 8, VK_QUERY_RESULT_64_BIT);
  if (result == VK_SUCCESS) ui_device_ms_ = double(ticks[1] - ticks[0]) * device_.timestampNs() * 1e-6;
}

void WindowSurface::readCapture() {
  reads_ = false;
  captured_ = Image(width_, height_, 3);
  const auto* bytes = static_cast<const std::uint8_t*>(capture_.mapped);
  const bool swaps = format_ == VK_FORMAT_B8G8R8A8_UNORM;
  for (std::size_t i = 0; i < captured_.pixelCount(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      captured_.pixels[3 * i + c] = srgbDecode(float(bytes[4 * i + (swaps ? 2 - c : c)]) / 255.0f);
    }
  }
}

}  // namespace gloam::view
