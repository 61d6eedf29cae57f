// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <deque>
#include <utility>

#include "gpu/device_state.h"
#include "gpu/frame_graph.h"
#include "gpu/pass_record.h"
#include "gpu/resource_pool.h"

namespace gloam::gpu {

/// What one of the two frames in flight owns.
struct Slot {
  explicit Slot(Device& device) : sets(device) {}
  VkCommandPool pool = VK_NULL_HANDLE;
  /// Of the pool; resetting it keeps them, so that each frame frees its own.
  std::vector<VkCommandBuffer> commands;
VkQueryPool queries = VK_NULL_HANDLE;
  std::uint32_t query_capacity = 0;
  DescriptorSets sets;
  std::uint64_t value = 0;  ///< of the timeline, when its last submission is done
};

/// A pass of the last frame.
struct TimedPass {
  std::string name;
  bool on_host = false;
  double host_ms = 0.0;
  std::uint32_t first_query = 0;
};

struct FrameGraph::State {
  explicit State(Device& d) : device(d), slots{Slot(d), Slot(d)}, pool(d) {}

  Device& device;
  std::array<Slot, 2> slots;
  ResourcePool pool;
  std::deque<Pass> passes;
  std::vector<std::pair<ImageRef, VkImageLayout>> final_layouts;
  std::uint64_t frame = 0;
  bool recording = false, timed = false;
  std::vector<TimedPass> timings;
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

}  // namespace gloam::gpu
