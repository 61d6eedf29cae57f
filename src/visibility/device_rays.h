// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "visibility/box_tree.h"
#include "visibility/visibility.h"

namespace gloam::visibility {

/// Visibility by a compute pass that walks through a hierarchy of boxes. The host builds it when the scene is new and refits it
/// when something moved. Holes of alpha masks are taken as closed.
class DeviceRays {
 public:
  explicit DeviceRays(gpu::Device& device) : device_(device) {}
  /// Adds "NAME_hierarchy", a host pass, and "NAME". Throws Error where the scene exceeds what a buffer of the device holds.
  void record(gpu::FrameGraph& graph, const std::string& name, const frame::GpuScene& scene, HostWorld& world,
              const Question& question, gpu::BufferRef visible);

 private:
  void update(const gpu::HostAccess& access, const HostWorld& world);

  gpu::Device& device_;
  BoxTree tree_;
  std::uint64_t layout_ = 0, pose_ = 0;  // of what the buffers hold
  std::size_t capacity_ = 0;             // triangles
  gpu::Buffer nodes_, triangles_;
};

}  // namespace gloam::visibility
