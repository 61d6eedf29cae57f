// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// All that a picture depends on, as plain data: the window changes it, the thread that draws gets copies.
#pragma once

#include <gloam/lights.h>
#include <gloam/renderer.h>
#include <gloam/spheres.h>

#include <memory>
#include <string>

#include "node_moves.h"
#include "technique_needs.h"

namespace gloam::view {

/// A scene with what was baked of it. Never changed once others see it: what is baked later makes a new one.
struct LoadedScene {
  std::string name;  ///< as it was asked for: a file or builtin:NAME
  bool ground = false;
  std::string spheres;  ///< file of sphere sets that it is drawn by; empty: fitted ones
  Scene scene;
  std::shared_ptr<const LoadedScene>
      unbaked;                          ///< what this is a bake of, made here; null where it came as it is
  bool apart = false;                   ///< that bake is of objects apart
  std::vector<int> light_nodes;         ///< nodes of PosedScene::lights, in that order
  std::vector<int> instance_nodes;      ///< of PosedScene::instances
  std::vector<glm::vec3> mesh_middles;  ///< of each mesh's box, in its own axes
};
/// Fills in what follows from the scene.
std::shared_ptr<const LoadedScene> makeLoadedScene(LoadedScene given);

/// What spheres are fitted to: what was baked of, so that a bake fits none anew; the scene itself where the bake took its objects
/// apart or made more of them.
std::shared_ptr<const LoadedScene> fittedScene(const std::shared_ptr<const LoadedScene>& loaded);

/// A technique with its options.
struct Pick {
  const TechniqueInfo* info = nullptr;
  Settings settings;
};
/// With its defaults.
inline Pick pickOf(const TechniqueInfo& info) {
  return {&info, Settings(info.options)};
}

enum class Split { kNone, kTechnique, kReference };

struct ViewState {
  std::shared_ptr<const LoadedScene> scene;
  Needs needs;                               ///< spheres and the like, of that scene
  std::shared_ptr<const DistantLight> base;  ///< light from afar, before it is turned and scaled
  float env_rotation_deg = 0.0f, env_intensity = 1.0f;
  AnimatedLights lights;
  cli::NodeMoves moves;  ///< by a hand
  float time_s = 0.0f;
  PosedCamera camera;
  Pick left, right;
  Split split = Split::kNone;
  std::string show;  ///< a layer or an image of the technique; empty: the light
  int width = 0, height = 0;
  int supersample = 1;
  bool background = true;
  bool layers = false;  ///< normal, depth, albedo, object: for the inspector and for picking
  DisplayOptions display;
};

/// Middles of all instances as they stand.
std::vector<glm::vec3> instancePlaces(const LoadedScene& loaded, const PosedScene& posed);
/// The light at its time, turned and scaled: described, for the renderer, in microseconds.
Environment describedLight(const ViewState& state);
/// The same painted, for the path tracer.
Environment paintedLight(const ViewState& state);

}  // namespace gloam::view
