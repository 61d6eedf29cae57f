// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The place of builtin:assembly: what stands still, and where what moves has to be. Metres.
#pragma once

#include "scene/scene_builder.h"

namespace gloam::assembly {

inline constexpr float kStations_m[] = {-0.8f, 0.0f, 0.8f};  // along the line: drums, heads, ram
inline constexpr float kHidden_m[] = {-2.0f, 2.05f};   // within the housings where toys come from and go
inline constexpr float kRollers_m = 0.5f;              // their top
inline constexpr glm::vec3 kArm{-0.8f, 0.0f, -0.72f};  // its vertical axis
inline constexpr float kShoulder_m = 0.96f;
inline constexpr glm::vec3 kMagazine{-0.2f, 0.0f, -0.72f};  // a tube out of which drums rise
inline constexpr float kMagazineTop_m = 0.92f;
inline constexpr float kPipeWait_m = 1.52f;  // a head's height within its pipe
inline constexpr float kRail_m = 2.02f, kRailOut_m = 0.42f, kLampRadius_m = 0.13f;

/// Floor, wall, rollers, housings, tube, pipe, press and rail: one node.
void addHall(SceneBuilder& builder, const Detail& detail);

/// Height of the ram's plate.
float ramHeight(float time_s);

}  // namespace gloam::assembly
