// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/frame_graph.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstring>
#include <deque>
#include <utility>

#include "gpu/device_state.h"
#include "gpu/format.h"
#include "gpu/pass_record.h"
#include "gpu/resource_pool.h"

namespace gloam::gpu {
namespace {

constexpr Access kTransferRead{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
constexpr Access kTransferWrite{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};

/// What one of the two frames in flight owns.
struct Slot {
  explicit Slot(Device& device) : sets(device) {}
  VkCommandPool pool = VK_NULL_HANDLE;
  std::vector<VkCommandBuffer> commands;  ///< of the pool; resetting it keeps them, so that each frame frees its own
  VkQueryPool queries = VK_NULL_HANDLE;
  std::uint32_t query_capacity = 0;
  DescriptorSets sets;
  std::uint64_t value = 0;  ///< of the timeline, when its last submission is done
};

struct Timed {
  std::string name;
  bool on_host = false;
  double host_ms = 0.0;
  std::uint32_t first_query = 0;
};

VkImageSubresourceLayers layersOf(const ImageRef& ref) {
  const ImageRange& range = ref.range();
  return {formatInfo(ref.format()).aspect, static_cast<std::uint32_t>(range.mip),
          static_cast<std::uint32_t>(range.layer), static_cast<std::uint32_t>(range.layers)};
}

VkOffset3D cornerOf(const ImageRef& ref) {
  return {ref.width(), ref.height(), ref.depth()};
}

}  // namespace

struct FrameGraph::State {
  explicit State(Device& d) : device(d), slots{Slot(d), Slot(d)}, pool(d) {}

  Device& device;
  std::array<Slot, 2> slots;
  ResourcePool pool;
  std::deque<Pass> passes;
  std::vector<std::pair<ImageRef, VkImageLayout>> final_layouts;
  std::uint64_t frame = 0;
  bool recording = false, timed = false;
  std::vector<Timed> timings;
  std::vector<PassTime> times;
  bool times_are_read = true;

  Slot& slot() { return slots[frame % 2]; }
  template <class T>
  T& add(T pass) {
    if (!recording) throw Error("pass '" + pass.name + "'", "stands outside a frame: begin() comes first");
    return std::get<T>(passes.emplace_back(std::move(pass)));
  }
  void addTransfer(const std::string& name, std::vector<Touch> touches,
                   std::function<void(VkCommandBuffer)> commands) {
    add(TransferPass{name, std::move(touches), std::move(commands)});
  }
  std::vector<std::vector<Touch>> check(std::vector<std::vector<bool>>& loads);
  VkCommandBuffer open();
  void prepareQueries(VkCommandBuffer commands);
  void record(VkCommandBuffer commands, const Pass& pass, const std::vector<Touch>& touches,
              const std::vector<bool>& loads);
  void runHost(const HostPass& pass);
  /// Software drivers rasterise later than their timestamps say: there each pass is waited for and timed by the
  /// host's clock.
  bool timesByWaiting() const { return timed && device.info().software; }
  void runTimed(VkCommandBuffer commands, const std::string& name, VkSemaphore wait);
  void readTimes();
};

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

void FrameGraph::clear(const std::string& name, ImageRef image, const ClearColor& value) {
  if (!image) throw Error("pass '" + name + "'", "clears an empty reference");
  const VkImageSubresourceRange range{
      formatInfo(image.format()).aspect, static_cast<std::uint32_t>(image.range().mip),
      static_cast<std::uint32_t>(image.range().mips), static_cast<std::uint32_t>(image.range().layer),
      static_cast<std::uint32_t>(image.range().layers)};
  const VolkDeviceTable& vk = state_->device.vk();
  state_->addTransfer(name, {{"(cleared)", image, {}, kTransferWrite, false, true}},
                      [=, &vk](VkCommandBuffer commands) {
                        if (range.aspectMask == VK_IMAGE_ASPECT_DEPTH_BIT) {
                          const VkClearDepthStencilValue depth{value.value.float32[0], 0};
                          vk.vkCmdClearDepthStencilImage(commands, image.image().handle(),
                                                         kTransferWrite.layout, &depth, 1, &range);
                        } else {
                          vk.vkCmdClearColorImage(commands, image.image().handle(), kTransferWrite.layout,
                                                  &value.value, 1, &range);
                        }
                      });
}

void FrameGraph::clear(const std::string& name, BufferRef buffer, std::uint32_t word) {
  if (!buffer) throw Error("pass '" + name + "'", "clears an empty reference");
  if (buffer.offset() % 4 != 0)
    throw Error("pass '" + name + "'", "clears from an offset that is no multiple of 4");
  const VolkDeviceTable& vk = state_->device.vk();
  state_->addTransfer(
      name, {{"(cleared)", {}, buffer, kTransferWrite, false, true}}, [=, &vk](VkCommandBuffer commands) {
        const VkDeviceSize bytes = (buffer.bytes() + 3) & ~std::size_t{3};
        if (bytes > 0) vk.vkCmdFillBuffer(commands, buffer.buffer().handle(), buffer.offset(), bytes, word);
      });
}

void FrameGraph::copy(const std::string& name, ImageRef from, ImageRef to) {
  const std::string place = "pass '" + name + "'";
  if (!from || !to) throw Error(place, "copies an empty reference");
  if (from.range().mips != 1 || to.range().mips != 1 || from.range().layers != to.range().layers) {
    throw Error(place, "copies one mip of as many layers on both sides");
  }
  const bool same = from.format() == to.format() && from.width() == to.width() &&
                    from.height() == to.height() && from.depth() == to.depth();
  if (!same && formatInfo(from.format()).aspect != VK_IMAGE_ASPECT_COLOR_BIT) {
    throw Error(place, "depth is copied only between images of the same size and format");
  }
  const VolkDeviceTable& vk = state_->device.vk();
  state_->addTransfer(
      name, {{"(from)", from, {}, kTransferRead, true, false}, {"(to)", to, {}, kTransferWrite, false, true}},
      [=, &vk](VkCommandBuffer commands) {
        if (same) {
          const VkImageCopy region{
              layersOf(from),
              {},
              layersOf(to),
              {},
              {static_cast<std::uint32_t>(from.width()), static_cast<std::uint32_t>(from.height()),
               static_cast<std::uint32_t>(from.depth())}};
          vk.vkCmdCopyImage(commands, from.image().handle(), kTransferRead.layout, to.image().handle(),
                            kTransferWrite.layout, 1, &region);
        } else {
          const VkImageBlit region{layersOf(from), {{}, cornerOf(from)}, layersOf(to), {{}, cornerOf(to)}};
          vk.vkCmdBlitImage(commands, from.image().handle(), kTransferRead.layout, to.image().handle(),
                            kTransferWrite.layout, 1, &region, VK_FILTER_LINEAR);
        }
      });
}

void FrameGraph::copy(const std::string& name, BufferRef from, BufferRef to) {
  if (!from || !to) throw Error("pass '" + name + "'", "copies an empty reference");
  if (from.bytes() > to.bytes()) {
    throw Error("pass '" + name + "'", "copies " + std::to_string(from.bytes()) + " bytes into the " +
                                           std::to_string(to.bytes()) + " of '" + to.name() + "'");
  }
  const VolkDeviceTable& vk = state_->device.vk();
  state_->addTransfer(
      name, {{"(from)", {}, from, kTransferRead, true, false}, {"(to)", {}, to, kTransferWrite, false, true}},
      [=, &vk](VkCommandBuffer commands) {
        const VkBufferCopy region{from.offset(), to.offset(), from.bytes()};
        if (region.size == 0) return;
        vk.vkCmdCopyBuffer(commands, from.buffer().handle(), to.buffer().handle(), 1, &region);
      });
}

void FrameGraph::leaveIn(ImageRef image, VkImageLayout layout) {
  state_->final_layouts.emplace_back(image, layout);
}

// ---- Running -------------------------------------------------------------------------------------------------------

/// All passes, before any of them runs: names, kinds and sizes; and that nothing is read that this frame has not made.
std::vector<std::vector<Touch>> FrameGraph::State::check(std::vector<std::vector<bool>>& loads) {
  std::vector<std::vector<Touch>> touches;
  for (const auto& pass : passes) {
    touches.push_back(checkPass(device, pass));
    auto& load = loads.emplace_back();
    if (const auto* raster = std::get_if<RasterPass>(&pass)) {
      for (const auto& target : raster->colors) load.push_back(isWritten({{}, target.image}, frame));
    }
    for (const auto& touch : touches.back()) {
      if (!touch.reads || isWritten(touch, frame)) continue;
      const std::string& name = touch.buffer ? touch.buffer.name() : touch.image.name();
      throw Error("pass '" + nameOf(pass) + "'", "reads '" + name + "' (" + touch.binding +
                                                     "), which no pass before it has written in this frame");
    }
    for (const auto& touch : touches.back()) {
      if (touch.writes && !isWritten(touch, frame)) markWritten(touch, frame);
    }
  }
  return touches;
}

VkCommandBuffer FrameGraph::State::open() {
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = slot().pool;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  gpu::check(device.vk().vkAllocateCommandBuffers(device.handle(), &info, &commands), "gpu",
             "vkAllocateCommandBuffers");
  slot().commands.push_back(commands);
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  gpu::check(device.vk().vkBeginCommandBuffer(commands, &begin), "gpu", "vkBeginCommandBuffer");
  return commands;
}

void FrameGraph::State::prepareQueries(VkCommandBuffer commands) {
  timings.clear();
  times.clear();
  times_are_read = !timed;
  if (!timed || timesByWaiting() || device.limits().timestamp_ns == 0.0) return;
  const auto needed = static_cast<std::uint32_t>(2 * passes.size());
  if (needed == 0) return;
  if (needed > slot().query_capacity) {
    device.vk().vkDestroyQueryPool(device.handle(), slot().queries, nullptr);
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = std::max(64u, std::bit_ceil(needed));
    slot().queries = VK_NULL_HANDLE;
    gpu::check(device.vk().vkCreateQueryPool(device.handle(), &info, nullptr, &slot().queries), "gpu",
               "vkCreateQueryPool");
    slot().query_capacity = info.queryCount;
  }
  device.vk().vkCmdResetQueryPool(commands, slot().queries, 0, needed);
}

void FrameGraph::State::record(VkCommandBuffer commands, const Pass& pass, const std::vector<Touch>& touches,
                               const std::vector<bool>& loads) {
  const InstanceFunctions& instance = device.state().instance.functions;
  const std::string& name = nameOf(pass);
  if (instance.beginLabel != nullptr) {
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = name.c_str();
    instance.beginLabel(commands, &label);
  }
  const bool stamped = timed && !timesByWaiting() && device.limits().timestamp_ns != 0.0;
  const auto query = static_cast<std::uint32_t>(2 * timings.size());
  const auto stamp = [&](std::uint32_t index) {
    if (!stamped) return;
    device.vk().vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot().queries, index);
  };
  stamp(query);
  BarrierBatch barriers;
  for (const auto& touch : touches) {
    if (touch.buffer) barriers.add(touch.buffer.buffer(), touch.access);
    if (touch.image) barriers.add(touch.image.image(), touch.image.range(), touch.access);
  }
  barriers.record(device, commands);
  if (const auto* compute = std::get_if<ComputePass>(&pass))
    recordCompute(device, slot().sets, commands, *compute);
  if (const auto* raster = std::get_if<RasterPass>(&pass)) {
    recordRaster(device, slot().sets, commands, *raster, loads);
  }
  if (const auto* transfer = std::get_if<TransferPass>(&pass)) transfer->commands(commands);
  stamp(query + 1);
  if (timed && !timesByWaiting()) timings.push_back({name, false, 0.0, query});
  if (instance.endLabel != nullptr) instance.endLabel(commands);
}

/// Submits one recorded pass alone and waits for it.
void FrameGraph::State::runTimed(VkCommandBuffer commands, const std::string& name, VkSemaphore wait) {
  const auto start = std::chrono::steady_clock::now();
  slot().value = device.state().submit(commands, wait, VK_NULL_HANDLE);
  device.state().waitFor(slot().value);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
  timings.push_back({name, true, taken.count(), 0});
}

void FrameGraph::State::runHost(const HostPass& pass) {
  const auto start = std::chrono::steady_clock::now();
  HostAccess access(pass);
  pass.function(access);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
  if (timed) timings.push_back({pass.name, true, taken.count(), 0});
}

void FrameGraph::execute(const SubmitInfo& submit) {
  State& state = *state_;
  if (!state.recording) throw Error("frame graph", "execute() without begin()");
  state.recording = false;
  std::vector<std::vector<bool>> loads;
  const auto touches = state.check(loads);

  VkSemaphore wait = submit.wait;
  VkCommandBuffer commands = state.open();
  state.prepareQueries(commands);
  for (std::size_t i = 0; i < state.passes.size(); ++i) {
    const auto* host = std::get_if<HostPass>(&state.passes[i]);
    if (host == nullptr) {
      state.record(commands, state.passes[i], touches[i], loads[i]);
      if (!state.timesByWaiting()) continue;
      state.runTimed(commands, nameOf(state.passes[i]), std::exchange(wait, VK_NULL_HANDLE));
      commands = state.open();
      continue;
    }
    state.slot().value = state.device.state().submit(commands, wait, VK_NULL_HANDLE);
    wait = VK_NULL_HANDLE;
    state.device.state().waitFor(state.slot().value);
    state.runHost(*host);
    commands = state.open();
  }
  BarrierBatch barriers;
  for (const auto& [image, layout] : state.final_layouts) {
    barriers.add(image.image(), image.range(),
                 {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, layout});
  }
  barriers.record(state.device, commands);
  state.slot().value = state.device.state().submit(commands, wait, submit.signal);
}

void FrameGraph::wait() {
  for (const auto& slot : state_->slots) state_->device.state().waitFor(slot.value);
  state_->device.state().collect();
}

void FrameGraph::setTimed(bool timed) {
  state_->timed = timed;
}

void FrameGraph::State::readTimes() {
  times_are_read = true;
  std::vector<std::uint64_t> ticks(2 * timings.size());
  if (slot().queries != VK_NULL_HANDLE && device.limits().timestamp_ns != 0.0) {
    for (const auto& timing : timings) {
      if (timing.on_host) continue;
      gpu::check(device.vk().vkGetQueryPoolResults(device.handle(), slot().queries, timing.first_query, 2,
                                                   2 * sizeof(std::uint64_t), &ticks[timing.first_query],
                                                   sizeof(std::uint64_t),
                                                   VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                 "gpu", "vkGetQueryPoolResults");
    }
  }
  for (const auto& timing : timings) {
    const auto first = static_cast<std::size_t>(timing.first_query);
    const double ms = timing.on_host ? timing.host_ms
                                     : static_cast<double>(ticks[first + 1] - ticks[first]) *
                                           device.limits().timestamp_ns * 1e-6;
    const auto known = std::find_if(times.begin(), times.end(),
                                    [&](const PassTime& time) { return time.name == timing.name; });
    if (known == times.end()) {
      times.push_back({timing.name, ms});
    } else {
      known->milliseconds += ms;
    }
  }
}

std::vector<PassTime> FrameGraph::times() {
  if (!state_->times_are_read) {
    wait();
    state_->readTimes();
  }
  return state_->times;
}

}  // namespace gloam::gpu
