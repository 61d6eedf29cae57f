// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Draws what Dear ImGui lists, with textures of our own (the backend of Dear ImGui 1.86 knows only that of its letters).
#pragma once

#include <imgui.h>

#include <array>
#include <cstdint>
#include <vector>

#include "window_device.h"

namespace gloam::view {

/// What ImTextureID holds.
enum class TextureSlot : std::intptr_t { kLetters = 1, kLeft, kRight, kCount };
inline ImTextureID textureId(TextureSlot slot) {
  return reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(slot));
}

class UiRenderer {
 public:
  UiRenderer(const WindowDevice& device, VkFormat target);
  ~UiRenderer();
  UiRenderer(const UiRenderer&) = delete;
  UiRenderer& operator=(const UiRenderer&) = delete;

  /// New pixels (RGBA, 8 bits, rows from the top) of a texture. Only while the device draws nothing.
  void setTexture(TextureSlot slot, int width, int height, const std::uint8_t* rgba);
  /// Before rendering begins: copies new pixels.
  void recordUploads(VkCommandBuffer commands);
  /// Within rendering. Only while the device draws nothing else of this.
  void record(VkCommandBuffer commands, const ImDrawData& data);

 private:
  struct Texture {
    WindowDevice::Image image;
    WindowDevice::Buffer staging;
    VkDescriptorSet set = VK_NULL_HANDLE;
    bool pending = false;
  };
  void createLayouts();
  void createPipeline(VkFormat target);
  void fillBuffers(const ImDrawData& data);
  void ensure(WindowDevice::Buffer& buffer, std::size_t bytes, VkBufferUsageFlags usage);
  Texture& texture(ImTextureID id);

  const WindowDevice& device_;
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  WindowDevice::Buffer vertices_, indices_;
  std::array<Texture, std::size_t(TextureSlot::kCount)> textures_;
};

}  // namespace gloam::view
