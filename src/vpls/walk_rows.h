// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "vpls/light_sources.h"
#include "vpls/walks.h"

namespace gloam::vpls {

/// How many rows of each kind a set has.
struct WalkPlan {
  int sets = 0, lamps = 0, direct = 0;
  std::vector<int> paths;  ///< that reach bounce 1, 2, … of a set
  int indirect() const;
  std::uint32_t stride() const { return std::uint32_t(lamps + direct + indirect() + 3) / 4 * 4; }
};

/// With `candidates` times as many rows for lit surfaces as asked for. Throws Error for counts below 0 or beyond what is made.
WalkPlan planWalks(const WalkOptions& options, std::size_t lamps, int candidates);

/// What sends light in a frame.
struct WalkLights {
  const visibility::HostWorld& world;
  std::span<const frame::LightRow> lamps;
  const Emitters& emitters;
  const EnvironmentTable& environment;
  glm::vec3 low{0.0f}, high{0.0f};  ///< box of the scene
  Focus focus = {};                 ///< of what comes from far away
};

/// Rows of all sets, in their places; those that send nothing are of kSightNothing. On all cores; the same for any number.
std::vector<WalkVpl> makeRows(const WalkPlan& plan, const WalkLights& lights);

/// A row that nobody sees.
WalkVpl emptyRow();
/// It is there, and its light is a number above 0.
bool sends(const WalkVpl& row);

/// Moves the rows of a set that send to its beginning; says how many there are of each kind.
visibility::SightSet packRows(const WalkPlan& plan, std::size_t set, std::span<WalkVpl> rows);

}  // namespace gloam::vpls
