// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What `gloam bake` was asked for, and whether it fits together.
#pragma once

#include <gloam/bake.h>

#include <optional>
#include <string>
#include <vector>

#include "bake_limits.h"
#include "bake_neighbourhood.h"
#include "bake_pca.h"
#include "bake_surfaces.h"
#include "bake_volume.h"
#include "scene_inputs.h"

namespace gloam::cli {

struct BakeChoice {
  SceneChoice scene;
  BakeOptions options;
  LimitChoice limits;
  SurfaceChoice surfaces;
  PcaChoice pca;
  NeighbourhoodChoice neighbourhood;
  VolumeChoice volumes;
  std::string output, kind = "di", glossy = "auto";
  bool half_float = false, resume = true, estimate_only = false, non_manifold = false;
  const CLI::Option* directions_option = nullptr;
  const CLI::Option* bounce_directions_option = nullptr;
  const CLI::Option* bounces_option = nullptr;
  const CLI::Option* time_option = nullptr;
  const CLI::Option* non_manifold_option = nullptr;
  std::vector<const CLI::Option*> of_gloss;  ///< that are of matrices

  BakeFileForm fileForm() const {
    return {half_float, pca.wanted ? pca.options.clusters : 0, pca.wanted ? pca.options.vectors : 0};
  }
};

/// What is wrong with the options whatever the scene: those that contradict each other, a name that cannot be written. Found
/// before hours of work. Throws Error.
void checkBakeChoice(const BakeChoice& choice);
/// What is wrong with a scene some of whose edges have more than two triangles, unless --non-manifold bakes it all the same.
std::optional<Error> manifoldFault(const BakeChoice& choice, const Scene& scene);
/// A line for each option that was given and changes nothing, in this scene.
void remarkUnusedOptions(const BakeChoice& choice, const Scene& scene, Console& console);

}  // namespace gloam::cli
