// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a technique must be given before it can light a scene: a bake, spheres. Made once, kept by the cache of the command
// line, then at hand: a second switch to the technique costs nothing.
#pragma once

#include <gloam/spheres.h>
#include <gloam/spherical_lights.h>

#include <memory>

namespace gloam::view {

struct LoadedScene;
struct Pick;

/// Spheres of one scene, by their number, and what they send.
struct Needs {
  std::shared_ptr<const SceneSpheres> spheres;
  std::shared_ptr<const SceneEmission> emission;  ///< null until a technique asked for it
  int sphere_count = -1;                          ///< as asked for
  const LoadedScene* of = nullptr;                ///< the scene that they belong to
};

/// Whether the scene carries a bake of the kind that the technique asks for with its options, as `gloam render` makes it. A
/// bake that came with the scene serves all.
bool hasBakeFor(const Pick& pick, const LoadedScene& scene);
/// Whether all that the technique needs is there, but for a bake.
bool hasSpheresFor(const Pick& pick, const LoadedScene& scene, const Needs& needs);

}  // namespace gloam::view
