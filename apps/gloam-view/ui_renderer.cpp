// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "ui_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "shaders/view_shaders.h"

namespace gloam::view {
namespace {

struct Push {
  float scale[2], shift[2];
};

VkShaderModule makeModule(const WindowDevice& device, const gpu::ShaderCode& code) {
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = code.word_count * 4;
  info.pCode = code.words;
  VkShaderModule module = VK_NULL_HANDLE;
  check(device.vk().CreateShaderModule(device.handle(), &info, nullptr, &module), "vkCreateShaderModule");
  return module;
}

}  // namespace

UiRenderer::UiRenderer(const WindowDevice& device, VkFormat target) : device_(device) {
  createLayouts();
  createPipeline(target);
}

UiRenderer::~UiRenderer() {
  for (Texture& t : textures_) {
    device_.destroy(t.image);
    device_.destroy(t.staging);
  }
  device_.destroy(vertices_);
  device_.destroy(indices_);
  const VulkanTable& vk = device_.vk();
  vk.DestroyPipeline(device_.handle(), pipeline_, nullptr);
  vk.DestroyPipelineLayout(device_.handle(), layout_, nullptr);
  vk.DestroyDescriptorPool(device_.handle(), pool_, nullptr);
  vk.DestroyDescriptorSetLayout(device_.handle(), set_layout_, nullptr);
  vk.DestroySampler(device_.handle(), sampler_, nullptr);
}

void UiRenderer::createLayouts() {
  const VulkanTable& vk = device_.vk();
  VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
  sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  check(vk.CreateSampler(device_.handle(), &sampler, nullptr, &sampler_), "vkCreateSampler");
  VkDescriptorSetLayoutBinding binding{};
  binding.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  binding.descriptorCount = 1;
  binding.stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT;
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.bindingCount = 1;
  set.pBindings = &binding;
  check(vk.CreateDescriptorSetLayout(device_.handle(), &set, nullptr, &set_layout_),
        "vkCreateDescriptorSetLayout");
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, std::uint32_t(textures_.size())};
  VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool.maxSets = std::uint32_t(textures_.size());
  pool.poolSizeCount = 1;
  pool.pPoolSizes = &size;
  check(vk.CreateDescriptorPool(device_.handle(), &pool, nullptr, &pool_), "vkCreateDescriptorPool");
  for (Texture& t : textures_) {
    VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.descriptorPool = pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout_;
    check(vk.AllocateDescriptorSets(device_.handle(), &allocate, &t.set), "vkAllocateDescriptorSets");
  }
  const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(Push)};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &set_layout_;
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &range;
  check(vk.CreatePipelineLayout(device_.handle(), &layout, nullptr, &layout_), "vkCreatePipelineLayout");
}

void UiRenderer::createPipeline(VkFormat target) {
  const VulkanTable& vk = device_.vk();
  VkPipelineShaderStageCreateInfo stages[2] = {{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO},
                                               {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO}};
  stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  stages[0].module = makeModule(device_, view_ui_vert_spv);
  stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  stages[1].module = makeModule(device_, view_ui_frag_spv);
  stages[0].pName = stages[1].pName = "main";
  const VkVertexInputBindingDescription binding{0, sizeof(ImDrawVert), VK_VERTEX_INPUT_RATE_VERTEX};
  const VkVertexInputAttributeDescription attributes[3] = {
      {0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, pos)},
      {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, uv)},
      {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(ImDrawVert, col)}};
  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  input.vertexBindingDescriptionCount = 1;
  input.pVertexBindingDescriptions = &binding;
  input.vertexAttributeDescriptionCount = 3;
  input.pVertexAttributeDescriptions = attributes;
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.lineWidth = 1.0f;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineColorBlendAttachmentState attachment{};
  attachment.blendEnable = VK_TRUE;
  attachment.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
  attachment.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  attachment.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  attachment.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  attachment.colorWriteMask = 0xf;
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = 1;
  blend.pAttachments = &attachment;
  const VkDynamicState dynamics[2] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = 2;
  dynamic.pDynamicStates = dynamics;
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &target;
  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  info.pNext = &rendering;
  info.stageCount = 2;
  info.pStages = stages;
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = layout_;
  const VkResult result =
      vk.CreateGraphicsPipelines(device_.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
  for (const auto& stage : stages) vk.DestroyShaderModule(device_.handle(), stage.module, nullptr);
  check(result, "vkCreateGraphicsPipelines");
}

UiRenderer::Texture& UiRenderer::texture(ImTextureID id) {
  return textures_[std::size_t(reinterpret_cast<std::intptr_t>(id))];
}

void UiRenderer::setTexture(TextureSlot slot, int width, int height, const std::uint8_t* rgba) {
  Texture& t = textures_[std::size_t(slot)];
  const std::size_t bytes = std::size_t(width) * std::size_t(height) * 4;
  if (t.image.width != width || t.image.height != height) {
    device_.destroy(t.image);
    t.image = device_.createImage(width, height);
    VkDescriptorImageInfo image{sampler_, t.image.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = t.set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    device_.vk().UpdateDescriptorSets(device_.handle(), 1, &write, 0, nullptr);
  }
  ensure(t.staging, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  std::memcpy(t.staging.mapped, rgba, bytes);
  t.pending = true;
}

void UiRenderer::ensure(WindowDevice::Buffer& buffer, std::size_t bytes, VkBufferUsageFlags usage) {
  if (buffer.bytes >= bytes) return;
  device_.destroy(buffer);
  buffer = device_.createBuffer(bytes, usage);
}

void UiRenderer::recordUploads(VkCommandBuffer commands) {
  const VulkanTable& vk = device_.vk();
  for (Texture& t : textures_) {
    if (!t.pending) continue;
    t.pending = false;
    moveLayout(vk, commands, t.image.handle, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
               0, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
               VK_PIPELINE_STAGE_TRANSFER_BIT);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {std::uint32_t(t.image.width), std::uint32_t(t.image.height), 1};
    vk.CmdCopyBufferToImage(commands, t.staging.handle, t.image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                            1, &copy);
    moveLayout(vk, commands, t.image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_ACCESS_TRANSFER_WRITE_BIT,
               VK_ACCESS_SHADER_READ_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
               VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT);
  }
}

void UiRenderer::fillBuffers(const ImDrawData& data) {
  ensure(vertices_, std::max<std::size_t>(1 << 16, std::size_t(data.TotalVtxCount) * sizeof(ImDrawVert)),
         VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  ensure(indices_, std::max<std::size_t>(1 << 16, std::size_t(data.TotalIdxCount) * sizeof(ImDrawIdx)),
         VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  auto* vertex = static_cast<ImDrawVert*>(vertices_.mapped);
  auto* index = static_cast<ImDrawIdx*>(indices_.mapped);
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    vertex = std::copy_n(list.VtxBuffer.Data, list.VtxBuffer.Size, vertex);
    index = std::copy_n(list.IdxBuffer.Data, list.IdxBuffer.Size, index);
  }
}

void UiRenderer::record(VkCommandBuffer commands, const ImDrawData& data) {
  const VulkanTable& vk = device_.vk();
  const ImVec2 pixels(data.DisplaySize.x * data.FramebufferScale.x,
                      data.DisplaySize.y * data.FramebufferScale.y);
  if (pixels.x < 1.0f || pixels.y < 1.0f || data.TotalVtxCount == 0) return;
  fillBuffers(data);
  vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
  const VkDeviceSize zero = 0;
  vk.CmdBindVertexBuffers(commands, 0, 1, &vertices_.handle, &zero);
  vk.CmdBindIndexBuffer(commands, indices_.handle, 0,
                        sizeof(ImDrawIdx) == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32);
  const VkViewport viewport{0.0f, 0.0f, pixels.x, pixels.y, 0.0f, 1.0f};
  vk.CmdSetViewport(commands, 0, 1, &viewport);
  const Push push{{2.0f / data.DisplaySize.x, 2.0f / data.DisplaySize.y},
                  {-1.0f - data.DisplayPos.x * 2.0f / data.DisplaySize.x,
                   -1.0f - data.DisplayPos.y * 2.0f / data.DisplaySize.y}};
  vk.CmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof push, &push);
  std::uint32_t first_index = 0;
  std::int32_t first_vertex = 0;
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback != nullptr) continue;
      const float left =
          std::clamp((command.ClipRect.x - data.DisplayPos.x) * data.FramebufferScale.x, 0.0f, pixels.x);
      const float top =
          std::clamp((command.ClipRect.y - data.DisplayPos.y) * data.FramebufferScale.y, 0.0f, pixels.y);
      const float right =
          std::clamp((command.ClipRect.z - data.DisplayPos.x) * data.FramebufferScale.x, 0.0f, pixels.x);
      const float bottom =
          std::clamp((command.ClipRect.w - data.DisplayPos.y) * data.FramebufferScale.y, 0.0f, pixels.y);
      Texture& t = texture(command.GetTexID());
      if (right <= left || bottom <= top || t.image.handle == VK_NULL_HANDLE) continue;
      const VkRect2D scissor{{std::int32_t(left), std::int32_t(top)},
                             {std::uint32_t(right - left), std::uint32_t(bottom - top)}};
      vk.CmdSetScissor(commands, 0, 1, &scissor);
      vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &t.set, 0, nullptr);
      vk.CmdDrawIndexed(commands, command.ElemCount, 1, first_index + command.IdxOffset,
                        first_vertex + std::int32_t(command.VtxOffset), 0);
    }
    first_index += std::uint32_t(list.IdxBuffer.Size);
    first_vertex += list.VtxBuffer.Size;
  }
}

}  // namespace gloam::view
