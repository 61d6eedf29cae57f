// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/program.h"

#include <algorithm>

#include "gpu/device_state.h"
#include "gpu/shader_reload.h"

namespace gloam::gpu {
namespace {

/// Vulkan's form of a Specialization; points into the maps it was made from.
struct SpecializationInfo {
  explicit SpecializationInfo(const Specialization& constants) {
    for (const auto& [id, word] : constants) {
      entries.push_back(
          {id, static_cast<std::uint32_t>(words.size() * sizeof(std::uint32_t)), sizeof(std::uint32_t)});
      words.push_back(word);
    }
    info = {static_cast<std::uint32_t>(entries.size()), entries.data(), words.size() * sizeof(std::uint32_t),
            words.data()};
  }
  std::vector<VkSpecializationMapEntry> entries;
  std::vector<std::uint32_t> words;
  VkSpecializationInfo info{};
};

VkPipelineShaderStageCreateInfo stageInfo(VkShaderStageFlagBits stage, VkShaderModule module,
                                          const VkSpecializationInfo* specialization) {
  VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage = stage;
  info.module = module;
  info.pName = "main";
  info.pSpecializationInfo = specialization;
  return info;
}

VkPipelineColorBlendAttachmentState blendState(Blend blend) {
  VkPipelineColorBlendAttachmentState state{};
  state.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT |
                         VK_COLOR_COMPONENT_A_BIT;
  state.blendEnable = blend != Blend::kNone;
  state.srcColorBlendFactor = state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  state.dstColorBlendFactor = state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  if (blend == Blend::kAlphaOver) {
    state.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    state.dstColorBlendFactor = state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  }
  if (blend == Blend::kMultiply) {
    state.srcColorBlendFactor = VK_BLEND_FACTOR_DST_COLOR;
    state.srcAlphaBlendFactor = VK_BLEND_FACTOR_DST_ALPHA;
    state.dstColorBlendFactor = state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
  }
  return state;
}

VkPipelineRasterizationStateCreateInfo rasterization(const RasterState& state, const Features& features) {
  VkPipelineRasterizationStateCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  info.depthClampEnable = state.depth_clamp && features.depth_clamp;
  info.polygonMode = state.wireframe && features.wireframe ? VK_POLYGON_MODE_LINE : VK_POLYGON_MODE_FILL;
  info.cullMode = state.cull;
  info.frontFace = state.front;
  info.depthBiasEnable = state.depth_bias_constant != 0.0f || state.depth_bias_slope != 0.0f;
  info.depthBiasConstantFactor = state.depth_bias_constant;
  info.depthBiasSlopeFactor = state.depth_bias_slope;
  info.lineWidth = 1.0f;
  return info;
}

VkPipelineDepthStencilStateCreateInfo depthState(const RasterState& state) {
  VkPipelineDepthStencilStateCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  info.depthTestEnable = state.depth_test;
  info.depthWriteEnable = state.depth_write;
  info.depthCompareOp = state.depth_compare;
  return info;
}

}  // namespace

Program::Program(Device& device, std::vector<const ShaderCode*> stages)
    : device_(device), stages_(std::move(stages)), interface_(reflect(*stages_.at(0))) {
  if (stages_.size() > 1) interface_ = join(interface_, reflect(*stages_[1]));
  const VkShaderStageFlags stages_there = interface_.stages;
  if (stages_there != VK_SHADER_STAGE_COMPUTE_BIT && stages_there != VK_SHADER_STAGE_VERTEX_BIT &&
      stages_there != (VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT)) {
    throw Error(interface_.name,
                "a program is a compute shader, or a vertex shader with or without a fragment shader");
  }
  if (interface_.push_bytes > device.limits().max_push_bytes) {
    throw Error(interface_.name, "a push block of " + std::to_string(interface_.push_bytes) + " bytes; '" +
                                     device.info().name + "' has " +
                                     std::to_string(device.limits().max_push_bytes));
  }
  createLayouts();
  for (const ShaderCode* code : stages_) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = code->word_count * sizeof(std::uint32_t);
    info.pCode = code->words;
    VkShaderModule module = VK_NULL_HANDLE;
    check(device.vk().vkCreateShaderModule(device.handle(), &info, nullptr, &module), code->name,
          "vkCreateShaderModule");
    modules_.push_back(module);
  }
}

Program::~Program() {
  const VolkDeviceTable& vk = device_.state().vk;
  const VkDevice device = device_.state().device;
  for (const auto& [constants, pipeline] : compute_pipelines_)
    vk.vkDestroyPipeline(device, pipeline, nullptr);
  for (const auto& variant : raster_pipelines_) vk.vkDestroyPipeline(device, variant.pipeline, nullptr);
  for (const auto module : modules_) vk.vkDestroyShaderModule(device, module, nullptr);
  vk.vkDestroyPipelineLayout(device, layout_, nullptr);
  for (const auto layout : set_layouts_) vk.vkDestroyDescriptorSetLayout(device, layout, nullptr);
}

bool Program::isCompute() const {
  return interface_.stages == VK_SHADER_STAGE_COMPUTE_BIT;
}

void Program::createLayouts() {
  std::uint32_t sets = 0;
  for (const auto& binding : interface_.bindings) sets = std::max(sets, binding.set + 1);
  for (std::uint32_t set = 0; set < sets; ++set) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const auto& binding : interface_.bindings) {
      if (binding.set == set) bindings.push_back({binding.binding, binding.type, 1, binding.stages, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    info.bindingCount = static_cast<std::uint32_t>(bindings.size());
    info.pBindings = bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    check(device_.vk().vkCreateDescriptorSetLayout(device_.handle(), &info, nullptr, &layout),
          interface_.name, "vkCreateDescriptorSetLayout");
    set_layouts_.push_back(layout);
  }
  const VkPushConstantRange push{interface_.push_stages, 0, interface_.push_bytes};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = sets;
  info.pSetLayouts = set_layouts_.data();
  info.pushConstantRangeCount = interface_.push_bytes > 0 ? 1 : 0;
  info.pPushConstantRanges = &push;
  check(device_.vk().vkCreatePipelineLayout(device_.handle(), &info, nullptr, &layout_), interface_.name,
        "vkCreatePipelineLayout");
}

VkPipeline Program::computePipeline(const Specialization& constants) {
  VkPipeline& pipeline = compute_pipelines_[constants];
  if (pipeline != VK_NULL_HANDLE) return pipeline;
  const SpecializationInfo specialization(constants);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = stageInfo(VK_SHADER_STAGE_COMPUTE_BIT, modules_[0], &specialization.info);
  info.layout = layout_;
  check(device_.vk().vkCreateComputePipelines(device_.handle(), device_.state().pipeline_cache, 1, &info,
                                              nullptr, &pipeline),
        interface_.name, "vkCreateComputePipelines");
  device_.state().nameObject(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline),
                             interface_.name);
  return pipeline;
}

VkPipeline Program::rasterPipeline(const Specialization& constants, const RasterState& state,
                                   const AttachmentFormats& attachments) {
  for (const auto& known : raster_pipelines_) {
    if (known.state == state && known.attachments == attachments && known.constants == constants) {
      return known.pipeline;
    }
  }
  RasterVariant variant{constants, state, attachments, VK_NULL_HANDLE};
  variant.pipeline = createRasterPipeline(variant);
  raster_pipelines_.push_back(variant);
  return variant.pipeline;
}

VkPipeline Program::createRasterPipeline(const RasterVariant& variant) {
  const SpecializationInfo specialization(variant.constants);
  std::vector<VkPipelineShaderStageCreateInfo> stages{
      stageInfo(VK_SHADER_STAGE_VERTEX_BIT, modules_[0], &specialization.info)};
  if (modules_.size() > 1) {
    stages.push_back(stageInfo(VK_SHADER_STAGE_FRAGMENT_BIT, modules_[1], &specialization.info));
  }
  const VkPipelineVertexInputStateCreateInfo no_attributes{
      VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = variant.state.topology;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  const auto raster = rasterization(variant.state, device_.features());
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  const auto depth = depthState(variant.state);
  const std::vector<VkPipelineColorBlendAttachmentState> blends(variant.attachments.colors.size(),
                                                                blendState(variant.state.blend));
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = static_cast<std::uint32_t>(blends.size());
  blend.pAttachments = blends.data();
  const VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = 2;
  dynamic.pDynamicStates = dynamic_states;
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.colorAttachmentCount = static_cast<std::uint32_t>(variant.attachments.colors.size());
  rendering.pColorAttachmentFormats = variant.attachments.colors.data();
  rendering.depthAttachmentFormat = variant.attachments.depth;

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
  info.stageCount = static_cast<std::uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &no_attributes;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = layout_;
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(device_.vk().vkCreateGraphicsPipelines(device_.handle(), device_.state().pipeline_cache, 1, &info,
                                               nullptr, &pipeline),
        interface_.name, "vkCreateGraphicsPipelines");
  device_.state().nameObject(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline),
                             interface_.name);
  return pipeline;
}

Program& programFor(Device& device, const std::vector<const ShaderCode*>& stages) {
  std::vector<const ShaderCode*> newest;
  std::vector<const std::uint32_t*> key;
  for (const ShaderCode* code : stages) {
    newest.push_back(&currentShader(*code));
    key.push_back(newest.back()->words);
  }
  auto& program = device.state().programs[key];
  if (!program) program = std::make_unique<Program>(device, std::move(newest));
  return *program;
}

}  // namespace gloam::gpu
