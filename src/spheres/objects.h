// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What of a scene gets a sphere set: objects, which of them only receive, how many spheres each gets.
#pragma once

#include <gloam/spheres.h>

#include "spheres/solid.h"

namespace gloam::spheres {

struct Object {
  SphereSet set;
  Solid solid;
  glm::mat4 world_from_unit{1.0f};  ///< of its first place, at the time of the bake
  float world_scale3 = 1.0f;        ///< world volume a unit volume
  std::size_t places = 1;
  std::vector<float> outside;  ///< volume outside it of 1, 2, 4 … spheres, roughly, in the world
  int count = 0;               ///< spheres it gets
  bool casts() const { return set.receive_only.empty(); }
  /// A ball: one sphere holds next to no air beside it, more would do no better.
  bool round() const { return outside.front() < 0.02f * solid.volume * world_scale3; }
};

/// Where the vertices of a deforming object are at some instants of the scene's animation, in units of its solid; each
/// instant scaled so that the surface keeps its area. Without instants where nothing is animated.
Motion motionOf(const Object& object, const Scene& scene);

/// One for each different list of meshes and stretch, in the order of nodes; each with its solid.
std::vector<Object> listObjects(const Scene& scene, const PosedScene& posed, const Progress& progress);

/// Marks what only receives: without area, flat, a room round something else.
void markReceivers(std::vector<Object>& objects, const PosedScene& posed);

/// Times its own volume outside: what a set among those of other objects may not hold.
inline constexpr double kTooLoose = 12.0;

/// Gives out `count` spheres to those that cast, one at least; an object that stands in n places takes n at a time. 0: as many
/// as leave no object with more air than three times its volume (what deforms: once), 26 to 128 together. Among others, what would hold far too much air by its share only receives, and others get that.
void spreadCount(std::vector<Object>& objects, int count);

/// Vertices, spread over the part of the surface that each sphere is nearest to by |p - c| / r.
void addAnchors(SphereSet& set, const Scene& scene);

/// 32 hexadecimal digits of the meshes' positions and triangles.
std::string geometryOf(const Scene& scene, const std::vector<int>& meshes);

}  // namespace gloam::spheres
