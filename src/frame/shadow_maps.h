// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "frame/gpu_scene.h"
#include "frame/lights.h"

namespace gloam::frame {

/// What local_light (and later virtual point lights) look at.
struct ShadowMaps {
  gpu::ImageRef maps;            ///< D32 array, one layer a view, reversed depth: 0 where nothing was drawn
  std::vector<LightRow> lights;  ///< the lamps of this frame
  gpu::BufferRef light_rows;     ///< the same on the device
  gpu::BufferRef view_rows;      ///< ShadowView, one a layer

  gpu::BufferRef lightRow(std::size_t light) const {
    return light_rows.slice(light * sizeof(LightRow), sizeof(LightRow));
  }
  /// The views of one lamp; of a lamp without maps, any.
  gpu::BufferRef viewRows(std::size_t light) const {
    const LightRow& row = lights[light];
    return row.map_count == 0
               ? view_rows
               : view_rows.slice(row.first_map * sizeof(ShadowView), row.map_count * sizeof(ShadowView));
  }
};

/// Draws the scene into every map: passes "frame.shadow_maps", and "frame.shadow_maps_masked" where materials
/// have holes; neither where maps that were drawn with the same `key` (standing.h) still stand.
ShadowMaps recordShadowMaps(gpu::FrameGraph& graph, const GpuScene& scene, const LightPlan& plan,
                            const std::string& key);

}  // namespace gloam::frame
