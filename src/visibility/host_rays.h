// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Whether points see each other, by Embree on the host in the middle of a frame: the fastest means where the device is the host's
// own processor, and right on any.
#pragma once

#include <memory>
#include <span>

#include "frame/gpu_scene.h"

namespace gloam::trace {
class Tracer;
}

namespace gloam::visibility {

/// An end of a ray. The ray starts, or stops, `offset` metres off it along the normal, so that it does not meet the surface that
/// the point stands for.
struct Place {
  glm::vec3 position{0.0f}, normal{0.0f, 1.0f, 0.0f};
  float offset = 0.0f;
};

/// All triangles of the scene, in the world, as the device has them (HostWorld).
class HostRays {
 public:
  HostRays();
  ~HostRays();

  /// Says what update() will read.
  static void reads(gpu::HostPass& pass, const frame::GpuScene& scene);
  /// Inside that pass, which runs before the scene's next pose(): takes what moved. Throws Error where the hierarchy does not fit
  /// into memory.
  void update(const gpu::HostAccess& access, const frame::GpuScene& scene);

  /// Bit i of visible[k]: nothing stands between from[k] and to[i] (at most 64). Pairs that face away from each other see nothing.
  void trace(std::span<const Place> from, std::span<const Place> to, std::span<std::uint64_t> visible) const;

  std::uint64_t tracedRays() const;  ///< so far

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gloam::visibility
