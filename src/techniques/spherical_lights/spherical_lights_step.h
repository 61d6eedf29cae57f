// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What of a frame all passes read, and the second pass.
#pragma once

#include "frame/frame_inputs.h"
#include "techniques/spherical_lights/spherical_lights_rows.h"

namespace gloam::spherical_lights {

struct Step {
  gpu::FrameGraph& graph;
  const frame::FrameInputs& inputs;
  const Rows& rows;
  int blocking, visibility;  ///< kPerObject …, kMean …
  int divisor;
  bool repair, lamps_are_balls, indirect;
  gpu::BufferRef light, spheres, objects, meets, listed, glow, blocking_patches, sending_patches,
      patch_radiance;
  GatherParams params;
};

inline constexpr VkFormat kHalves = VK_FORMAT_R16G16B16A16_SFLOAT;

/// Rows on the device; at least one.
template <class T>
gpu::BufferRef uploadRows(gpu::FrameGraph& graph, const char* name, std::vector<T> rows) {
  if (rows.empty()) rows.push_back(T{});
  return graph.upload(name, rows);
}

/// What the first pass leaves.
struct Sending {
  gpu::BufferRef sent;  ///< a SentRow a sphere
  gpu::BufferRef points = {},
                 arriving = {};  ///< PointRow, and radiance of white there, a sample; none without spheres
};

/// Where step.inputs.show asks for one: a picture of spheres and samples, drawn for nobody else.
void recordView(const Step& step, const Sending& sending);

/// What receivers get: "spherical_lights.gather" at the asked size; below full size brought to all pixels by "…upsample",
/// "…widen" and "…repair". `sent`: a SentRow a sphere.
frame::Lighting recordGathering(const Step& step, gpu::BufferRef sent);

}  // namespace gloam::spherical_lights
