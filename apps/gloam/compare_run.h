// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The work of `gloam compare`: draws every contender, has the reference, measures, writes.
#pragma once

#include <gloam/reference.h>

#include <optional>
#include <string>

#include "json.h"
#include "scene_inputs.h"
#include "technique_choice.h"

namespace gloam::cli {

struct CompareChoice {
  SceneChoice scene;
  LightChoice light;
  ViewChoice view{.size = {512, 512}};
  bool size_given = false, supersample_given = false;
  TechniqueChoice options;  ///< of techniques, for all contenders of that name
  std::string techniques;   ///< compare_plan.h; empty: all that can light the scene
  std::string reference, output, device;
  std::optional<int> bounces, samples, environment_order, seed;
  float noise = 0.0f;
  int frames = 20;
  std::optional<float> exposure_stops;  ///< of the page; nothing: found in the reference
  bool use_cache = true;
  std::string spheres;  ///< a file of them
};

/// Throws Error before anything is written where the input is bad, Interrupted; what is finished then stays.
int runCompare(CompareChoice choice, Console& console);
/// The same without a word on standard output: what results.json has.
Json compareQuietly(CompareChoice choice, Console& console);

}  // namespace gloam::cli
