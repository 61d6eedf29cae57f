// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Run time of baked volumes (PRT-7).
#pragma once

#include "frame/frame_inputs.h"
#include "scene/volume_places.h"
#include "techniques/prt/prt_volume_shared.h"

namespace gloam::prt {

/// Transfer of the filled voxels of a scene's volumes, as halves, voxels side by side; light in 3D images each frame.
class VolumeBuffers {
 public:
  /// `order` bands are kept, 0: all that are baked. `chunk_bytes`: largest buffer, 0: what the device takes. Throws Error where a
  /// volume's numbers do not fit, and where its images are larger than the device draws.
  VolumeBuffers(gpu::Device& device, const frame::GpuScene& scene, int order, std::size_t chunk_bytes);

  int orderAskedFor() const { return order_; }
  bool empty() const { return volumes_.empty(); }

  /// Adds "prt.volume", once a chunk: every voxel's dot products with the light, which `window` was applied to, turned into the
  /// node's axes. Of the volumes of `scene` that are baked; the others are left out.
  std::vector<frame::VolumeLight> record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                         frame::Window window, bool indirect) const;

 private:
  struct Chunk {
    gpu::Buffer voxels, direct, indirect;
    std::uint32_t count = 0;
  };
  struct Baked {
    int node = kNone;
    int order = 0;
    bool has_indirect = false;
    std::vector<Chunk> chunks;
  };
  Baked makeVolume(gpu::Device& device, const PlacedVolume& placed, std::size_t chunk_bytes) const;

  int order_;
  std::vector<Baked> volumes_;
};

}  // namespace gloam::prt
