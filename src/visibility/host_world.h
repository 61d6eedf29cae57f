// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The scene as the device has it, deformed meshes too, made ready for rays on the host: triangles in one hierarchy, materials and
// textures to read where rays land.
#pragma once

#include <memory>

#include "frame/gpu_scene.h"
#include "visibility/world_tracer.h"

namespace gloam::visibility {

class HostWorld {
 public:
  HostWorld();
  ~HostWorld();

  /// Says what update() will read.
  static void reads(gpu::HostPass& pass, const frame::GpuScene& scene);
  /// Inside that pass, which runs before the scene's next pose(): takes what moved; nothing where nothing did.
  void update(const gpu::HostAccess& access, const frame::GpuScene& scene);

  // ---- After an update ----
  /// Built when it is first asked for after something moved, by one thread. Throws Error where it does not fit into memory.
  const WorldTracer& tracer() const;
  /// Meshes (and an empty one at the end), materials and textures (of at most 1024 texels a side) as trace/surface.h reads them. Meshes have positions, texture
  /// coordinates, colours and triangles, no normals.
  const Scene& scene() const;
  /// Instances in the order of GpuScene::instances().
  const PosedScene& posed() const;
  /// Another number for every set of instances, and for every change of where they are.
  std::uint64_t layoutRevision() const;
  std::uint64_t poseRevision() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gloam::visibility
