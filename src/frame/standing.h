// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the pictures that all techniques share are made of, as keys of kept images: while a key stays, they need not be drawn
// again. A hand that turns the light, moves a slider or switches techniques changes neither; one that moves the camera leaves
// the lamps' maps alone.
#pragma once

#include "frame/gpu_scene.h"
#include "frame/lights.h"

namespace gloam::frame {

/// Of the scene as it stands, the camera and the size. Empty where things are deformed: their vertices come anew every frame.
std::string gbufferKey(const GpuScene& scene, const FrameView& view);
/// Of the scene as it stands and the lamps' views. Empty as above.
std::string shadowKey(const GpuScene& scene, const LightPlan& plan);

}  // namespace gloam::frame
