// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// PX-7: sums over the proxies that reach a receiver, two ways: gathered by lists of tiles, or splatted with blending. The same
// sums to rounding.
#pragma once

#include "frame/frame_inputs.h"
#include "gpu/frame_graph.h"
#include "techniques/proxies/proxies_shared.h"

namespace gloam::proxies {

inline constexpr VkFormat kHalves = VK_FORMAT_R16G16B16A16_SFLOAT, kFloats = VK_FORMAT_R32G32B32A32_SFLOAT;

/// What of the frame is the same for every pass.
struct Step {
  gpu::FrameGraph& graph;
  const frame::FrameInputs& inputs;
  const frame::ReceiverLevel& level;
  gpu::BufferRef proxies, flats, light, log_table, alone_table, operator_table;
  std::uint32_t proxy_count, flat_count;
  AccumulateParams params;
  int indirect, exponential;
  bool normalise, whole_field;
  bool by_lanes;  ///< frame/lanes.glsl

  gpu::ImageRef image(const char* name, VkFormat format, int layers = 1) const {
    return graph.create(name,
                        {.format = format, .width = level.width, .height = level.height, .layers = layers});
  }
};

struct Sums {
  gpu::ImageRef log_visibility;  ///< four layers of four coefficients, floats
  gpu::ImageRef sent;            ///< indirect irradiance before normalisation; A: solid angles
};

/// Which proxies reach the pixels of a list (QuadList and at most `capacity` of them), by squares of kRepairTile pixels:
/// "proxies.repair_bounds", "proxies.repair_tiles".
struct RepairTiles {
  gpu::BufferRef bits;
  std::uint32_t columns = 0;
};
RepairTiles recordRepairTiles(const Step& step, gpu::BufferRef repairs, std::uint32_t capacity);

/// "proxies.bounds", "proxies.tiles", "proxies.accumulate".
Sums accumulateByTiles(const Step& step);
/// "proxies.splat_shadow", "proxies.splat_indirect". Receivers must be those of the picture.
Sums accumulateBySplats(const Step& step);

}  // namespace gloam::proxies
