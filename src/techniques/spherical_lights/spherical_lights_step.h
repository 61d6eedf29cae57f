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
  bool repair, lamps_are_balls, indirect, at_vertices;
  bool by_lanes;  ///< frame/lanes.glsl
  float coarse_limit;
  gpu::BufferRef light, spheres, objects, meets, listed, glow, levels, coarse, leaves, blocking_patches,
      sending_patches, patch_radiance;
  GatherParams params;  ///< coarse: 0 where no spheres are taken together
};

/// Whether the kernel that keeps sums along an order of groups takes these.
inline bool quick(int blocking, int visibility, std::size_t groups) {
  return visibility == kMean && blocking != kPerSphere && groups <= kMostKept;
}

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

/// SL-8: what coarse spheres send, in `sent` after all others.
void recordCoarse(const Step& step, gpu::BufferRef sent);
/// SL-8: of each cluster of receivers, a LevelRow an object, and a vec4 a coarse sphere: reflection ratio, and that of logs.
struct Cuts {
  gpu::BufferRef levels, ratios;
};
Cuts recordCuts(const Step& step, gpu::BufferRef sent, gpu::ImageRef position);

/// SL-10: all vertices of the scene as a picture of points, kVertexColumns wide; and back from there to the pixels.
struct VertexPoints {
  gpu::ImageRef position, normal;
  gpu::BufferRef first;  ///< an instance: its first point
};
VertexPoints recordVertices(const Step& step);
void recordInterpolation(const Step& step, const VertexPoints& vertices, gpu::ImageRef vertex_direct,
                         gpu::ImageRef vertex_indirect, gpu::ImageRef direct, gpu::ImageRef indirect);

/// Where step.inputs.show asks for one: a picture of spheres and samples, drawn for nobody else.
void recordView(const Step& step, const Sending& sending);

/// What receivers get: "spherical_lights.gather" at the asked size; below full size brought to all pixels by "…upsample",
/// "…widen" and "…repair". `sent`: a SentRow a sphere.
frame::Lighting recordGathering(const Step& step, gpu::BufferRef sent);

}  // namespace gloam::spherical_lights
