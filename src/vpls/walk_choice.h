// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Which virtual lights matter to the picture (row RF-7; in kind of Georgiev, Slusallek 2010, "Simple and robust iterative importance
// sampling of virtual point lights").
#pragma once

#include "vpls/walk_rows.h"

namespace gloam::vpls {

inline constexpr std::uint32_t kSeenPoints = 32;

/// Out of a plan's rows for lit surfaces, those of a plan with fewer: by how much they add at points that the camera sees, at all of these
/// alike. Other rows stay. A fifth of the choice is blind, so that no light is left out: sums stay true in the mean, and a row that is kept stands for
/// at most six times its light. No such points: a choice without preference.
std::vector<WalkVpl> chooseRows(const WalkPlan& from, std::span<const WalkVpl> candidates, const WalkPlan& to,
                                const visibility::WorldTracer& tracer,
                                std::span<const visibility::SightPoint> seen);

}  // namespace gloam::vpls
