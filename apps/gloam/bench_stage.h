// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What every measurement of a technique begins with.
#pragma once

#include <gloam/renderer.h>
#include <gloam/spheres.h>

#include <functional>

#include "scene_inputs.h"
#include "technique_choice.h"
#include "timings.h"

namespace gloam::cli {

inline constexpr int kWarmUpFrames = 2;  ///< shaders are compiled and memory is first touched there

struct BenchChoice {
  std::string subject;  ///< a technique, or a suite of bench_suites.h
  SceneChoice scene{.name = "builtin:spheres"};
  LightChoice light;
  ViewChoice view{.size = {512, 512}};
  TechniqueChoice technique;
  std::string device;
  int frames = 20;
  bool paper = false, scaling = false;
  float orbit_step_deg = 0.0f;  ///< that the camera turns about the scene from frame to frame
  std::string spheres;  ///< a file, in place of fitting
  std::string output;   ///< of a plot
  std::string figures;  ///< a folder: the paper's experiments against the reference
};

/// A technique made ready to draw.
struct BenchStage {
  Scene scene;
  Environment environment;
  SceneSpheres spheres;  ///< where the technique needs them
  PosedScene posed;
  PosedCamera camera;
  RenderOptions options;
  Renderer renderer;
};
/// Loads, bakes and fits as the technique needs. Throws Error.
BenchStage prepareBench(const BenchChoice& choice, Console& console);

/// Draws a frame and adds its times; milliseconds by the clock.
double drawTimed(BenchStage& stage, const RenderOptions& options, Timings& timings);

/// The command that was typed, for those who want to repeat it.
std::string benchCommand(const BenchChoice& choice, const char* option);

}  // namespace gloam::cli
