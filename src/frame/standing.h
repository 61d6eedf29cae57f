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

/// Of the scene as it stands: where its instances are, and the vertices of those that are deformed. `posed` is what scene.pose()
/// was given last.
std::string sceneKey(const GpuScene& scene, const PosedScene& posed);
/// Of the scene, the camera and the size.
std::string gbufferKey(const std::string& scene_key, const FrameView& view);
/// Of the scene and the lamps' views.
std::string shadowKey(const std::string& scene_key, const LightPlan& plan);

}  // namespace gloam::frame
