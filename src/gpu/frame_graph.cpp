// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What frames own, and what stands in them: resources and passes.
#include <cstring>

#include "gpu/frame_graph_state.h"

namespace gloam::gpu {

FrameGraph::FrameGraph(Device& device) : state_(std::make_unique<State>(device)) {
  for (auto& slot : state_->slots) {
    VkCommandPoolCreateInfo info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    info.queueFamilyIndex = device.queueFamily();
    check(device.vk().vkCreateCommandPool(device.handle(), &info, nullptr, &slot.pool), "gpu",
          "vkCreateCommandPool");
  }
}

FrameGraph::~FrameGraph() {
  Device& device = state_->device;
  try {
    wait();
  } catch (const Error&) {  // a lost device has finished all it will ever do
  }
  for (auto& slot : state_->slots) {
    device.vk().vkDestroyCommandPool(device.handle(), slot.pool, nullptr);
    device.vk().vkDestroyQueryPool(device.handle(), slot.queries, nullptr);
  }
}

Device& FrameGraph::device() const {
  return state_->device;
}

void FrameGraph::begin() {
  State& state = *state_;
  state.passes.clear();
  state.final_layouts.clear();
  ++state.frame;
  Slot& slot = state.slot();
  state.device.state().waitFor(slot.value);
  state.device.state().collect();
  check(state.device.vk().vkResetCommandPool(state.device.handle(), slot.pool,
                                             VK_COMMAND_POOL_RESET_RELEASE_RESOURCES_BIT),
        "gpu", "vkResetCommandPool");
  if (!slot.commands.empty()) {
    state.device.vk().vkFreeCommandBuffers(state.device.handle(), slot.pool,
                                           static_cast<std::uint32_t>(slot.commands.size()),
                                           slot.commands.data());
    slot.commands.clear();
  }
  slot.sets.reset();
  state.pool.begin(state.frame);
  state.recording = true;
}

// ---- Resources -----------------------------------------------------------------------------------------------------

ImageRef FrameGraph::create(const std::string& name, const ImageDesc& desc) {
  return state_->pool.create(name, desc);
}
BufferRef FrameGraph::create(const std::string& name, const BufferDesc& desc) {
  return state_->pool.create(name, desc);
}

BufferRef FrameGraph::uploadBytes(const std::string& name, std::span<const std::byte> data) {
  const BufferRef buffer = state_->pool.createUpload(name, data.size());
  if (!data.empty()) std::memcpy(buffer.buffer().mapped(), data.data(), data.size());
  return buffer;
}

ImageRef FrameGraph::import(const std::string& name, const Image& image) {
  state_->pool.import(name, ImageRef(image));
  return image;
}

BufferRef FrameGraph::import(const std::string& name, const Buffer& buffer) {
  state_->pool.import(name, BufferRef(buffer));
  return buffer;
}

ImageHistory FrameGraph::history(const std::string& name, const ImageDesc& desc) {
  bool fresh = false;
  const ImageHistory history = state_->pool.history(name, desc, fresh);
  if (fresh) clear(name + ".zero", history.previous);
  return history;
}

BufferHistory FrameGraph::history(const std::string& name, const BufferDesc& desc) {
  bool fresh = false;
  const BufferHistory history = state_->pool.history(name, desc, fresh);
  if (fresh) clear(name + ".zero", history.previous);
  return history;
}

KeptImage FrameGraph::keep(const std::string& name, const ImageDesc& desc, const std::string& key) {
  return state_->pool.keep(name, desc, key);
}
void FrameGraph::setKeeps(bool keeps) {
  state_->pool.setKeeps(keeps);
}

void FrameGraph::resetHistory() {
  state_->pool.resetHistory();
}
ImageRef FrameGraph::find(const std::string& name) const {
  return state_->pool.findImage(name);
}
BufferRef FrameGraph::findBuffer(const std::string& name) const {
  return state_->pool.findBuffer(name);
}
std::vector<std::string> FrameGraph::imageNames() const {
  return state_->pool.imageNames();
}
std::uint64_t FrameGraph::memoryBytes() const {
  return state_->pool.memoryBytes();
}

// ---- Passes --------------------------------------------------------------------------------------------------------

ComputePass& FrameGraph::compute(const std::string& name, const ShaderCode& code) {
  ComputePass pass;
  pass.name = name;
  pass.program = &programFor(state_->device, {&code});
  if (!pass.program->isCompute())
    throw Error("pass '" + name + "'", std::string(code.name) + " is no compute shader");
  return state_->add(std::move(pass));
}

RasterPass& FrameGraph::raster(const std::string& name, const ShaderCode& vertex,
                               const ShaderCode& fragment) {
  RasterPass pass;
  pass.name = name;
  pass.program = &programFor(state_->device, {&vertex, &fragment});
  return state_->add(std::move(pass));
}

RasterPass& FrameGraph::raster(const std::string& name, const ShaderCode& vertex) {
  RasterPass pass;
  pass.name = name;
  pass.program = &programFor(state_->device, {&vertex});
  if (pass.program->isCompute())
    throw Error("pass '" + name + "'", std::string(vertex.name) + " is no vertex shader");
  return state_->add(std::move(pass));
}

HostPass& FrameGraph::host(const std::string& name) {
  HostPass pass;
  pass.name = name;
  return state_->add(std::move(pass));
}

void FrameGraph::leaveIn(ImageRef image, VkImageLayout layout) {
  state_->final_layouts.emplace_back(image, layout);
}

}  // namespace gloam::gpu
