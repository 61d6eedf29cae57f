// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A mesh as a body: how large, how thick, open or closed.
#pragma once

#include <functional>
#include <memory>

#include "spheres/surface.h"

namespace gloam::spheres {

/// Brought to a unit cube about the origin, so that nothing below depends on the unit of length.
struct Solid {
  Soup soup;
  glm::vec3 origin{0.0f};  ///< given = origin + scale * unit
  float scale = 0.0f;      ///< 0: without extent
  float area = 0.0f, signed_volume = 0.0f;
  glm::vec3 extents{0.0f};  ///< along its own axes, greatest first
  bool closed = false;      ///< every edge has as many triangles on one side as on the other
  bool inverted = false;    ///< faces look inward
  bool shell = false;       ///< encloses next to nothing: a sheet
  float volume = 0.0f;
  std::shared_ptr<const WindingTree> winding;
  std::shared_ptr<const Occupancy> coarse;  ///< 48 cells along the longest side

  /// Least over middle extent.
  float flatness() const { return extents.y > 0.0f ? extents.z / extents.y : 0.0f; }
  bool degenerate() const { return !(scale > 0.0f) || !(area > 0.0f); }
};

/// Triangles without area are left out.
Solid makeSolid(const Soup& given, const std::function<bool()>& should_stop = {});
/// Grid for a set of `count` balls: the ball of one count-th of the volume is some cells in radius.
std::shared_ptr<const Occupancy> makeOccupancy(const Solid& solid, int count,
                                               const std::function<bool()>& should_stop = {});

}  // namespace gloam::spheres
