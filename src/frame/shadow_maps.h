// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "frame/gpu_scene.h"
#include "frame/lights.h"

namespace gloam::frame {

/// What local_light (and later virtual point lights) look at.
struct ShadowMaps {
  gpu::ImageRef maps;     ///< D32 array, one layer a view, reversed depth: 0 where nothing was drawn
  gpu::BufferRef lights;  ///< LightRow
  gpu::BufferRef views;   ///< ShadowView
  std::uint32_t light_count = 0;
};

/// Draws the scene into every map: passes "frame.shadow_maps", and "frame.shadow_maps_masked" where materials have holes.
ShadowMaps recordShadowMaps(gpu::FrameGraph& graph, const GpuScene& scene, const LightPlan& plan);

}  // namespace gloam::frame
