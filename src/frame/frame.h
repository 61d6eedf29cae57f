// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One frame, from a posed scene to pictures.
#pragma once

#include <optional>
#include <span>

#include "frame/frame_inputs.h"
#include "frame/shade.h"

namespace gloam::frame {

struct FrameOptions {
  int width = 0, height = 0;  ///< of the picture
  int supersample = 1;
  int shadow_map_size = 1024;
  bool background = true;
  bool layers = true;  ///< normal, depth, albedo, object besides the light
  bool motion = false;
  std::span<const Proxy> proxies = {};  ///< for techniques that take spheres in place of what moves
  const Emission* emission = nullptr;   ///< what these send
  std::span<const Patch> flats = {};    ///< what has none, as blockers of light
  std::string_view show = {};           ///< FrameInputs::show
  /// The same technique, options and light as in the frame before. Where camera, scene and lamps are the same, too, somebody
  /// measures: all of the frame is drawn. Else what still stands of the frames before is taken from them.
  bool repeats = true;
};

/// What one frame leaves to the next.
struct FrameMemory {
  std::optional<FrameView> view;
  std::string gbuffer_key, shadow_key;
};

/// Adds all passes of a frame to the graph and says where the pictures will be. Throws Error where camera,
/// lamps or poses make no sense.
FrameImages recordFrame(gpu::FrameGraph& graph, GpuScene& scene, const EnvironmentLight& environment,
                        const PosedScene& posed, const PosedCamera& camera, const FrameOptions& options,
                        const LightingStep& technique, FrameMemory& memory, Warnings& warnings);

/// Bytes of device memory that images of such a frame take, without what the technique adds.
std::size_t estimateBytes(const FrameOptions& options);

}  // namespace gloam::frame
