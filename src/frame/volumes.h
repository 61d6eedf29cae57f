// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Smoke and cloud over what the surfaces show.
#pragma once

#include "frame/shade.h"

namespace gloam::frame {

/// Marches through each volume that the technique lit, from the farthest to the nearest, as far as the depth buffer, and lays it
/// over both images: "frame.volume". Says which volumes of the scene are left out, once.
void recordVolumes(gpu::FrameGraph& graph, const FrameInputs& inputs, const Lighting& lighting,
                   const glm::vec3& eye, const Shaded& shaded);

}  // namespace gloam::frame
