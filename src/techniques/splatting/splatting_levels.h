// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The levels of the buffer: what varies within their texels, which of them receive light, and their light brought to pixels
// (rows MS-3, MS-4, MS-6).
#pragma once

#include "frame/frame_inputs.h"
#include "techniques/splatting/splatting_lights.h"
#include "visibility/host_world.h"

namespace gloam::splatting {

/// Level k has texels of 2^k pixels a side; the last ones reach over the picture's edge.
struct Plan {
  int coarsest = 0;  ///< the level with `coarsest_texels` or more on the shorter side; 0: pixels alone
  int finest = 0;    ///< 0: pixels
};

/// `coarsest_texels`: at least, on the shorter side; `resolution`: at most, of the finest level; 0: pixels.
Plan planLevels(int width, int height, int coarsest_texels, int resolution);

struct Level {
  int width = 0, height = 0;
  gpu::ImageRef ranges, means;  ///< splatting_ranges.glsl. None at level 0
  gpu::BufferRef leaves;        ///< places of subsplats
  gpu::ImageRef light;          ///< irradiance of subsplats, A 1, else 0; none below the finest level
};

struct Subsplats {
  std::size_t most = 0;
  gpu::BufferRef points;     ///< Subsplat, coarse levels first
  gpu::BufferRef light;      ///< irradiance
  gpu::BufferRef counts;     ///< Counts
  gpu::BufferRef arguments;  ///< Groups, as splatting_shared.h says
};

/// MS-3: passes "splatting.ranges". By shading normals, or geometric ones.
std::vector<Level> recordRanges(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                                bool by_shading_normal);

/// To look at: images "splatting.least_K", "splatting.greatest_K" of ranges of level K (normal; eye depth).
void recordRangesToLookAt(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                          std::span<const Level> levels);

/// MS-4: passes "splatting.refine"; sets the levels' leaves.
Subsplats recordRefinement(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                           std::vector<Level>& levels, const Thresholds& thresholds, const LightSets& lights);

struct GatherOptions {
  bool paints_levels = false;  ///< a colour a level in place of light, to look at
  bool keeps_pixels = false;   ///< level 0 has an image of its own, else its light comes by recordPixels
  visibility::HostWorld* world = nullptr;  ///< MS-8: lights are hidden by what stands in the way
  int bound_kind = 1;                      ///< splatting_light.glsl
  float light_threshold =
      0.0f;  ///< MS-10: texels larger than this part of the mean distance of their light are split; 0: none
  float cluster_threshold = 0.0f;  ///< MS-9: what merging lights may change of their sum
};

/// MS-5, MS-8 to MS-10, from coarse to fine: "splatting.coarse", "splatting.gather", "splatting.visibility", "splatting.place"; sets
/// the levels' light.
void recordGather(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                  std::vector<Level>& levels, const Subsplats& subsplats, const LightSets& lights,
                  const GatherOptions& options);

enum class Upsampling : std::uint8_t {
  kSurfaces,  ///< MS-6, and not across edges that run along borders of texels
  kPaper,     ///< MS-6
  kNaive,     ///< to look at: each level interpolated with its gaps as darkness, and all added up
  kBlocks     ///< to look at: nearest
};

/// MS-6 and MS-7: passes "splatting.upsample" and "splatting.finish". Levels 0 … coarsest, at least two; where `light` is empty
/// the level has none of its own. Irradiance a pixel.
gpu::ImageRef recordUpsampling(gpu::FrameGraph& graph, std::span<const Level> levels,
                               const Thresholds& thresholds, Upsampling upsampling, float detail,
                               gpu::BufferRef view, gpu::ImageRef normals);

/// Light of pixels that are subsplats of their own into the picture, and MS-7: "splatting.place".
void recordPixels(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Level& pixels,
                  const Subsplats& subsplats, float detail, gpu::ImageRef irradiance);

}  // namespace gloam::splatting
