// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Virtual lights in Phong lobes (row MS-5).
#pragma once

#include "frame/frame_inputs.h"
#include "vpls/vpls.h"

namespace gloam::splatting {

/// Radiance that each pixel's Phong lobe gathers of all lights: passes "splatting.shiny" (which pixels have gloss) and
/// "splatting.gloss".
gpu::ImageRef recordGloss(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const vpls::Vpls& vpls,
                          int bound_kind);

}  // namespace gloam::splatting
