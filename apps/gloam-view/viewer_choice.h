// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What gloam-view is asked for: the options of `gloam render` under the same names, and those of a window.
#pragma once

#include <string>

#include "display_choice.h"
#include "node_moves.h"
#include "scene_inputs.h"
#include "technique_choice.h"

namespace gloam::view {

#ifdef GLOAM_SHADER_FOLDER  // of a build for those who write shaders
inline constexpr const char* kShaderFolder = GLOAM_SHADER_FOLDER;
#else
inline constexpr const char* kShaderFolder = "";
#endif

struct ViewerChoice {
  cli::SceneChoice scene{.name = "builtin:cornell"};
  bool scene_given = false;
  cli::LightChoice light;
  cli::ViewChoice view;
  std::vector<cli::MoveText> moves;
  cli::TechniqueChoice technique;
  cli::DisplayChoice display;
  std::string spheres;  ///< file of the scene's sphere sets
  std::string device, show;
  bool use_cache = true;

  std::string screenshot, window_screenshot, script, stats, shader_folder = kShaderFolder;
  int frames = 0;
  float ui_scale = 0.0f;  ///< 0: the display's
  float scale = 0.0f;     ///< of the picture's resolution; 0: found
  bool vsync = true, panel = true;
};

inline constexpr int kDefaultWidth = 1440, kDefaultHeight = 900;

/// Declares the options on a parser and parses. Throws Error; `help` is filled where it was asked for.
ViewerChoice parseArguments(const std::vector<std::string>& arguments, std::string* help);
/// What a preset sets, on top of the defaults. Throws Error that names the file and the key.
ViewerChoice readPreset(const std::string& file);

struct ViewState;
class CameraControl;
/// The view as options that `gloam render --settings` and readPreset take.
void writePreset(const std::string& file, const ViewState& state, const CameraControl& camera,
                 const std::string& environment, const std::vector<std::string>& lights);

}  // namespace gloam::view
