// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Reflective shadow maps (Dachsbacher, Stamminger 2005; row MS-1): what each lamp sees, and how much of its light each
// texel sends on.
#pragma once

#include "frame/frame_inputs.h"

namespace gloam::vpls {

/// One map: the view of a lamp, or one of the six faces of a cube around it.
struct ReflectiveMap {
  std::size_t light = 0;  ///< in ShadowMaps::lights
  frame::FrameView view{};
  int x = 0, y = 0;  ///< its first texel in the atlas
};

/// Images of all maps side by side. Names in the graph: vpls.position, vpls.normal, vpls.flux.
struct ReflectiveMaps {
  int size = 0;  ///< texels a side of a map
  std::vector<ReflectiveMap> maps;
  gpu::ImageRef position;  ///< world; w: area of surface in the texel, square metres; 0: nothing there
  gpu::ImageRef normal;    ///< geometric, on the lamp's side; w: distance from the lamp, metres
  gpu::ImageRef flux;      ///< RGB, watts that leave by k_d + k_s, all taken as diffuse
};

/// Views of the lamps. A spot of less than 60 degrees to each side has one, a point light and a wider spot six. A
/// directional light's covers the box of the scene, at a size and place that change in steps. Their axes change
/// steadily with the direction, but for one that points straight up. At most `most` maps: lamps beyond are left out,
/// which is told in `warnings`.
std::vector<ReflectiveMap> planReflectiveMaps(std::span<const frame::LightRow> lights,
                                              const glm::vec3& bounds_min, const glm::vec3& bounds_max,
                                              int size, std::size_t most, Warnings& warnings);

/// Draws all maps: passes "vpls.maps", the G-buffer from the lamps, and "vpls.reflect", the light in it. No lamps: no
/// images.
ReflectiveMaps recordReflectiveMaps(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, int size);

}  // namespace gloam::vpls
