// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What stands before the camera in a comparison, baked where a contender wants it, and how a contender draws it.
#pragma once

#include <gloam/spherical_lights.h>

#include "bake_run.h"
#include "compare_plan.h"
#include "compare_run.h"
#include "timings.h"

namespace gloam::cli {

struct CompareStage {
  Scene scene;  ///< as it was read: the reference is traced from it
  struct Bake {
    Scene scene;
    BakeTime time;
  };
  std::optional<Bake> baked, baked_apart;  ///< where a contender needs a bake that `scene` does not carry
  Environment environment;
  PosedScene posed;
  PosedCamera camera;
  int bounces = 1;  ///< of the reference
  int baked_bounces = 0;
  std::vector<bool> glowing;  ///< of posed.instances
  Coverage in_scene;          ///< the light that there is, at so many bounces
  /// Null where there is none.
  const Bake* bakeFor(const Contender& contender) const;
  const Scene& sceneFor(const Contender& contender) const {
    const Bake* bake = bakeFor(contender);
    return bake ? bake->scene : scene;
  }
};

/// Reads the scene and chooses light, camera and bounces; `reference_bounces` wins where a reference was given. Throws
/// Error where a contender cannot light the scene; where nobody asked for it by name it drops out, with a line. Bakes
/// nothing.
CompareStage prepareCompareStage(const CompareChoice& choice, std::vector<Contender>& contenders,
                                 std::optional<int> reference_bounces, Console& console);
/// Bakes where a contender needs it; finds baked_bounces.
void bakeCompareStage(CompareStage& stage, const CompareChoice& choice,
                      const std::vector<Contender>& contenders, Console& console);

struct Drawn {
  LayeredImage picture;
  Timings timings;
  Warnings warnings;
  std::string device;
};
/// Null unless the contender needs them.
struct ContenderSpheres {
  const SceneSpheres* sets = nullptr;
  const SceneEmission* sent = nullptr;
};
/// Draws a contender with a renderer of its own, so that memory and times do not depend on who was drawn before.
Drawn drawContender(const CompareStage& stage, const CompareChoice& choice, const Contender& contender,
                    const ContenderSpheres& spheres, bool background, const Progress& progress);

}  // namespace gloam::cli
