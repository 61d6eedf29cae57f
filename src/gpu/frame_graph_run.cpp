// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A frame's passes checked, recorded, submitted and timed.
#include <algorithm>
#include <bit>
#include <chrono>

#include "gpu/frame_graph_state.h"

namespace gloam::gpu {

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
  state.pool.finish();
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
