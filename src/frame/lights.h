// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Lamps (KHR_lights_punctual) as shaders know them, and the cameras from which their shadow maps are drawn.
#pragma once

#include <gloam/scene.h>

#include <span>

#include "frame/frame_shared.h"

namespace gloam::frame {

struct LightPlan {
  std::vector<LightRow> lights;
  std::vector<ShadowView> shadow_views;  ///< one a layer of the shadow maps
  int map_size = 0;                      ///< texels a side
};

/// Rows for the lamps that shine at all. A directional light's map covers what of the scene's box the camera
/// may see, at a size and place that change in steps, so that shadows do not swim while the camera moves; a
/// spot has one map, a point light and a spot wider than 60 degrees to each side six. Maps are halved in size
/// until all fit into `budget_bytes`; lamps beyond `max_layers` cast no shadow. Both are told in `warnings`.
/// Throws Error for a lamp whose numbers are not finite.
LightPlan planLights(std::span<const PosedLight> lights, const FrameView& view, const glm::vec3& bounds_min,
                     const glm::vec3& bounds_max, int map_size, std::size_t budget_bytes, int max_layers,
                     Warnings& warnings);

}  // namespace gloam::frame
