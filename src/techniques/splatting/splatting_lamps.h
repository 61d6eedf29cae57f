// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What is said of lamps that send no light into the scene.
#pragma once

#include "frame/frame_inputs.h"

namespace gloam::splatting {

/// A line for each lamp whose cone has no angle, that shines away from all there is, or whose range ends before it.
void tellLamps(const frame::FrameInputs& inputs);

}  // namespace gloam::splatting
