// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/pass_record.h"

#include <algorithm>
#include <map>

#include "gpu/device_state.h"

namespace gloam::gpu {
namespace {

constexpr std::uint32_t kSetsPerPool = 256;
constexpr std::uint32_t kDescriptorsPerPool = 2048;

/// One descriptor, ready to be written.
struct Descriptor {
  const Binding* binding = nullptr;
  VkDescriptorBufferInfo buffer{};
  VkDescriptorImageInfo image{};
};

Descriptor resolve(Device& device, const Binding& binding, const BoundResource& given) {
  Descriptor descriptor{&binding};
  if (given.buffer) {
    const BufferRef& ref = given.buffer;
    descriptor.buffer = {ref.buffer().handle(), ref.offset(), ref.bytes()};
    if (ref.bytes() == 0)
      descriptor.buffer = {ref.buffer().handle(), 0, 16};  // nothing to read, but something to bind
    return descriptor;
  }
  if (binding.type == VK_DESCRIPTOR_TYPE_SAMPLER ||
      binding.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER) {
    descriptor.image.sampler = device.state().sampler(given.sampler.value_or(kNearestClamp));
  }
  if (given.image) {
    descriptor.image.imageView = given.image.image().view(binding.view_type, given.image.range());
    descriptor.image.imageLayout = layoutFor(binding.type, given.image.image());
  }
  return descriptor;
}

/// Binds the sets of one program; sets with the same content are made once.
class SetBinder {
 public:
  SetBinder(Device& device, DescriptorSets& sets, VkCommandBuffer commands, Program& program,
            VkPipelineBindPoint point)
      : device_(device), sets_(sets), commands_(commands), program_(program), point_(point) {
    bound_.resize(program.setLayouts().size());
  }

  void bind(const Bindings& pass, const Bindings* draw) {
    for (std::uint32_t set = 0; set < bound_.size(); ++set) {
      const VkDescriptorSet handle = find(set, pass, draw);
      if (handle == bound_[set]) continue;
      device_.vk().vkCmdBindDescriptorSets(commands_, point_, program_.layout(), set, 1, &handle, 0, nullptr);
      bound_[set] = handle;
    }
  }

 private:
  VkDescriptorSet find(std::uint32_t set, const Bindings& pass, const Bindings* draw) {
    std::vector<Descriptor> descriptors;
    std::vector<std::uint64_t> key{set};
    for (const auto& binding : program_.interface().bindings) {
      if (binding.set != set) continue;
      const Descriptor d = resolve(device_, binding, *lookUp(binding.name, draw, pass));
      descriptors.push_back(d);
      key.insert(key.end(), {reinterpret_cast<std::uint64_t>(d.buffer.buffer), d.buffer.offset,
                             d.buffer.range, reinterpret_cast<std::uint64_t>(d.image.imageView),
                             reinterpret_cast<std::uint64_t>(d.image.sampler)});
    }
    VkDescriptorSet& known = known_[key];
    if (known == VK_NULL_HANDLE) known = write(set, descriptors);
    return known;
  }

  VkDescriptorSet write(std::uint32_t set, const std::vector<Descriptor>& descriptors) {
    const VkDescriptorSet handle = sets_.allocate(program_.setLayouts()[set]);
    std::vector<VkWriteDescriptorSet> writes;
    for (const auto& descriptor : descriptors) {
      VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
      write.dstSet = handle;
      write.dstBinding = descriptor.binding->binding;
      write.descriptorCount = 1;
      write.descriptorType = descriptor.binding->type;
      write.pBufferInfo = &descriptor.buffer;
      write.pImageInfo = &descriptor.image;
      writes.push_back(write);
    }
    device_.vk().vkUpdateDescriptorSets(device_.handle(), static_cast<std::uint32_t>(writes.size()),
                                        writes.data(), 0, nullptr);
    return handle;
  }

  Device& device_;
  DescriptorSets& sets_;
  VkCommandBuffer commands_;
  Program& program_;
  VkPipelineBindPoint point_;
  std::vector<VkDescriptorSet> bound_;
  std::map<std::vector<std::uint64_t>, VkDescriptorSet> known_;
};

void push(const Device& device, VkCommandBuffer commands, const Program& program,
          const std::vector<std::byte>& bytes) {
  if (bytes.empty()) return;
  device.vk().vkCmdPushConstants(commands, program.layout(), program.interface().push_stages, 0,
                                 static_cast<std::uint32_t>(bytes.size()), bytes.data());
}

VkRenderingAttachmentInfo attachment(const ImageRef& target, VkImageLayout layout) {
  VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  info.imageView = target.image().view(VK_IMAGE_VIEW_TYPE_2D, target.range());
  info.imageLayout = layout;
  info.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  return info;
}

/// Colour targets by the location of their output.
struct Targets {
  std::vector<VkRenderingAttachmentInfo> colors;
  VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  AttachmentFormats formats;
  VkRect2D area{};
};

Targets targetsOf(const RasterPass& pass, const std::vector<bool>& load) {
  Targets targets;
  std::size_t locations = 0;
  for (const auto& output : pass.program->interface().outputs) {
    locations = std::max<std::size_t>(locations, output.location + 1);
  }
  targets.colors.resize(locations, {VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO});
  targets.formats.colors.resize(locations, VK_FORMAT_UNDEFINED);
  for (std::size_t i = 0; i < pass.colors.size(); ++i) {
    const ColorTarget& target = pass.colors[i];
    for (const auto& output : pass.program->interface().outputs) {
      if (output.name != target.output) continue;
      auto& info = targets.colors[output.location];
      info = attachment(target.image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
      if (target.clear || !load[i]) info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
      if (target.clear) info.clearValue.color = target.clear->value;
      targets.formats.colors[output.location] = target.image.format();
    }
  }
  if (pass.depth_image) {
    targets.depth =
        attachment(pass.depth_image, pass.depth_read_only ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL
                                                          : VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    if (pass.depth_read_only) targets.depth.storeOp = VK_ATTACHMENT_STORE_OP_NONE;
    if (pass.depth_clear) {
      targets.depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
      targets.depth.clearValue.depthStencil.depth = *pass.depth_clear;
    }
    targets.formats.depth = pass.depth_image.format();
  }
  const ImageRef first = pass.colors.empty() ? pass.depth_image : pass.colors.front().image;
  const VkRect2D all{{0, 0},
                     {static_cast<std::uint32_t>(first.width()), static_cast<std::uint32_t>(first.height())}};
  targets.area = pass.area.value_or(all);
  return targets;
}

RasterState stateOf(const RasterPass& pass, const Draw& draw) {
  RasterState state = draw.own_state.value_or(pass.pass_state);
  if (draw.own_cull) state.cull = *draw.own_cull;
  if (!pass.depth_image) state.depth_test = false;
  if (!pass.depth_image || pass.depth_read_only) state.depth_write = false;
  return state;
}

void recordDraws(Device& device, DescriptorSets& sets, VkCommandBuffer commands, const RasterPass& pass,
                 const AttachmentFormats& formats) {
  const VolkDeviceTable& vk = device.vk();
  const std::string place = "pass '" + pass.name + "'";
  SetBinder binder(device, sets, commands, *pass.program, VK_PIPELINE_BIND_POINT_GRAPHICS);
  VkPipeline bound = VK_NULL_HANDLE;
  for (const auto& draw : pass.draws) {
    if (draw.count == 0 || draw.instances == 0) continue;
    const auto constants =
        specializationOf(place, pass.program->interface(), pass.bindings(), &draw.bindings());
    const VkPipeline pipeline = pass.program->rasterPipeline(constants, stateOf(pass, draw), formats);
    if (pipeline != bound) vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    bound = pipeline;
    binder.bind(pass.bindings(), &draw.bindings());
    push(device, commands, *pass.program,
         draw.bindings().push.empty() ? pass.bindings().push : draw.bindings().push);
    if (draw.indices) {
      vk.vkCmdBindIndexBuffer(commands, draw.indices.buffer().handle(), draw.indices.offset(),
                              VK_INDEX_TYPE_UINT32);
      vk.vkCmdDrawIndexed(commands, draw.count, draw.instances, draw.first, draw.vertex_offset,
                          draw.first_instance);
    } else {
      vk.vkCmdDraw(commands, draw.count, draw.instances, draw.first, draw.first_instance);
    }
  }
}

}  // namespace

DescriptorSets::~DescriptorSets() {
  for (const auto pool : pools_) device_.vk().vkDestroyDescriptorPool(device_.handle(), pool, nullptr);
}

void DescriptorSets::reset() {
  for (const auto pool : pools_) device_.vk().vkResetDescriptorPool(device_.handle(), pool, 0);
  current_ = 0;
}

VkDescriptorSet DescriptorSets::allocate(VkDescriptorSetLayout layout) {
  VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  info.descriptorSetCount = 1;
  info.pSetLayouts = &layout;
  for (;; ++current_) {
    const bool fresh = current_ == pools_.size();
    if (fresh) {
      constexpr VkDescriptorPoolSize kSizes[] = {
          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kDescriptorsPerPool},
          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kDescriptorsPerPool},
          {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kDescriptorsPerPool},
          {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, kDescriptorsPerPool},
          {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kDescriptorsPerPool},
          {VK_DESCRIPTOR_TYPE_SAMPLER, kDescriptorsPerPool}};
      VkDescriptorPoolCreateInfo create{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
      create.maxSets = kSetsPerPool;
      create.poolSizeCount = static_cast<std::uint32_t>(std::size(kSizes));
      create.pPoolSizes = kSizes;
      VkDescriptorPool pool = VK_NULL_HANDLE;
      check(device_.vk().vkCreateDescriptorPool(device_.handle(), &create, nullptr, &pool), "gpu",
            "vkCreateDescriptorPool");
      pools_.push_back(pool);
    }
    info.descriptorPool = pools_[current_];
    VkDescriptorSet set = VK_NULL_HANDLE;
    const VkResult result = device_.vk().vkAllocateDescriptorSets(device_.handle(), &info, &set);
    if (result == VK_SUCCESS) return set;
    if (fresh || (result != VK_ERROR_OUT_OF_POOL_MEMORY && result != VK_ERROR_FRAGMENTED_POOL)) {
      check(result, "gpu", "vkAllocateDescriptorSets");
    }
  }
}

void recordCompute(Device& device, DescriptorSets& sets, VkCommandBuffer commands, const ComputePass& pass) {
  const auto groups = groupsOf(device, pass);
  if (!pass.indirect && (groups[0] == 0 || groups[1] == 0 || groups[2] == 0)) return;
  const VolkDeviceTable& vk = device.vk();
  const auto constants =
      specializationOf("pass '" + pass.name + "'", pass.program->interface(), pass.bindings(), nullptr);
  vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pass.program->computePipeline(constants));
  SetBinder(device, sets, commands, *pass.program, VK_PIPELINE_BIND_POINT_COMPUTE)
      .bind(pass.bindings(), nullptr);
  push(device, commands, *pass.program, pass.bindings().push);
  if (pass.indirect) {
    vk.vkCmdDispatchIndirect(commands, pass.indirect.buffer().handle(), pass.indirect.offset());
  } else {
    vk.vkCmdDispatch(commands, groups[0], groups[1], groups[2]);
  }
}

void recordRaster(Device& device, DescriptorSets& sets, VkCommandBuffer commands, const RasterPass& pass,
                  const std::vector<bool>& load) {
  const VolkDeviceTable& vk = device.vk();
  const Targets targets = targetsOf(pass, load);
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea = targets.area;
  info.layerCount = 1;
  info.colorAttachmentCount = static_cast<std::uint32_t>(targets.colors.size());
  info.pColorAttachments = targets.colors.data();
  info.pDepthAttachment = pass.depth_image ? &targets.depth : nullptr;
  vk.vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{static_cast<float>(targets.area.offset.x),
                            static_cast<float>(targets.area.offset.y),
                            static_cast<float>(targets.area.extent.width),
                            static_cast<float>(targets.area.extent.height),
                            0.0f,
                            1.0f};
  vk.vkCmdSetViewport(commands, 0, 1, &viewport);
  vk.vkCmdSetScissor(commands, 0, 1, &targets.area);
  recordDraws(device, sets, commands, pass, targets.formats);
  if (pass.commands) pass.commands(commands);
  vk.vkCmdEndRendering(commands);
}

}  // namespace gloam::gpu
