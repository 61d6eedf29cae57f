// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The levels of the buffer: what varies within their texels, which of them receive light, and their light brought to pixels
// (rows MS-3, MS-4, MS-6).
#pragma once

#include "frame/frame_inputs.h"
#include "techniques/splatting/splatting_shared.h"
#include "visibility/host_rays.h"
#include "vpls/vpls.h"

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
  gpu::ImageRef least,
      greatest;             ///< geometric normal, eye depth; greatest depth -1: no surface. None at level 0
  gpu::ImageRef positions;  ///< mean; w: pixels that show a surface. None at level 0
  gpu::ImageRef shadings;   ///< mean shading normal. None at level 0
  gpu::BufferRef leaves;    ///< places of subsplats
  gpu::ImageRef light;      ///< irradiance of subsplats, A 1, else 0; none below the finest level
};

struct Subsplats {
  gpu::BufferRef points;     ///< Subsplat, coarse levels first
  gpu::BufferRef light;      ///< irradiance; A: its change, where asked for
  gpu::BufferRef counts;     ///< Counts
  gpu::BufferRef arguments;  ///< Groups: by level, then by level and chunk of lights
};

/// MS-3: passes "splatting.ranges". By shading normals, or geometric ones.
std::vector<Level> recordRanges(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                                bool by_shading_normal);

/// MS-4: passes "splatting.refine"; sets the levels' leaves.
Subsplats recordRefinement(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                           std::vector<Level>& levels, const Thresholds& thresholds, const vpls::Vpls& vpls);

struct GatherOptions {
  bool paints_levels = false;            ///< a colour a level in place of light, to look at
  visibility::HostRays* rays = nullptr;  ///< MS-8: lights are hidden by what stands in the way
  int bound_kind = 1;                    ///< splatting_light.glsl
  float light_threshold =
      0.0f;  ///< MS-10: texels larger than this part of the mean distance of their light are split; 0: none
};

/// MS-5, from coarse to fine: "splatting.points", "splatting.visibility", "splatting.gather", "splatting.converge", "splatting.place"; sets the levels'
/// light.
void recordGather(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const Plan& plan,
                  std::vector<Level>& levels, const Subsplats& subsplats, const vpls::Vpls& vpls,
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

}  // namespace gloam::splatting
