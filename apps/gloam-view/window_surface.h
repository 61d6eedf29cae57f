// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The images of the window, one after the other: swapchain, one frame in flight, what a screenshot reads back.
#pragma once

#include <gloam/image.h>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "ui_renderer.h"

namespace gloam::view {

class WindowSurface {
 public:
  WindowSurface(const WindowDevice& device, bool vsync);
  ~WindowSurface();
  WindowSurface(const WindowSurface&) = delete;
  WindowSurface& operator=(const WindowSurface&) = delete;

  /// Waits for the frame in flight: textures may change after it.
  void wait();
  UiRenderer& ui() { return *ui_; }
  /// Shows one frame in a window of that many pixels. Nothing is shown, and false comes back, while the window is minimised
  /// or its images are out of date; the next call makes new ones.
  bool show(int width, int height, const ImDrawData& data);
  /// The frame that is shown next is read back: linear R, G, B as writePng takes it. Throws Error where the surface cannot.
  void requestCapture() { capture_wanted_ = true; }
  /// What was read back, once; empty before.
  Image takeCapture() { return std::exchange(captured_, {}); }
  /// What the device took to draw panels and picture of the last frame.
  double uiDeviceMs() const { return ui_device_ms_; }
  void setVsync(bool vsync);

 private:
  void create(int width, int height);
  void destroyImages();
  void record(std::uint32_t index, const ImDrawData& data);
  void recordCopy(VkImage image);
  void readTimes();
  void readCapture();

  const WindowDevice& device_;
  bool vsync_, stale_ = true, capture_wanted_ = false, captures_ = false, in_flight_ = false, reads_ = false;
  VkFormat format_ = VK_FORMAT_UNDEFINED;
  VkColorSpaceKHR color_space_ = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  int width_ = 0, height_ = 0;
  std::vector<VkImage> images_;
  std::vector<VkImageView> views_;
  std::vector<VkSemaphore> drawn_;
  VkSemaphore acquired_ = VK_NULL_HANDLE;
  VkFence fence_ = VK_NULL_HANDLE;
  VkCommandPool command_pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkQueryPool times_ = VK_NULL_HANDLE;
  std::unique_ptr<UiRenderer> ui_;
  WindowDevice::Buffer capture_;
  Image captured_;
  double ui_device_ms_ = 0.0;
};

}  // namespace gloam::view
