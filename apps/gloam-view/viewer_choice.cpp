// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "viewer_choice.h"

#include <fmt/core.h>
#include <image/atomic_file.h>

#include <algorithm>

#include "camera_control.h"
#include "file_names.h"
#include "settings_file.h"
#include "spheres_run.h"
#include "view_state.h"

namespace gloam::view {
namespace {

void addWindowOptions(CLI::App& app, ViewerChoice& choice) {
  cli::addName(app, "--screenshot", choice.screenshot, "FILE",
               "saves the picture as .png or .exr after --frames, and quits")
      ->group("Window");
  cli::addName(app, "--window-screenshot", choice.window_screenshot, "FILE",
               "saves the window with its panels as .png after --frames, and quits")
      ->group("Window");
  cli::addInteger(app, "--frames", choice.frames, {1, 1000000}, "N", "pictures to draw before a screenshot")
      ->default_str("2")
      ->group("Window");
  cli::addName(app, "--script", choice.script, "FILE", "plays input from a JSON file (docs/viewer.md)")
      ->group("Window");
  cli::addName(app, "--stats", choice.stats, "FILE", "writes times, memory and counts as JSON when it quits")
      ->group("Window");
  cli::addNumber(app, "--scale", choice.scale, {0.05, 1.0}, "SHARE",
                 "of the window's resolution each way; found by default")
      ->group("Window");
  cli::addNumber(app, "--ui-scale", choice.ui_scale, {0.5, 4.0}, "FACTOR",
                 "of letters and panels; by default the display's")
      ->group("Window");
  cli::addName(app, "--watch-shaders", choice.shader_folder, "DIR",
               "the src folder of gloam's source tree: shaders edited there are compiled and shown at once")
      ->group("Window");
  app.add_flag_callback(
         "--no-vsync", [&choice] { choice.vsync = false; }, "shows pictures as soon as they are there")
      ->group("Window");
  app.add_flag_callback(
         "--no-panel", [&choice] { choice.panel = false; }, "begins with the panels hidden")
      ->group("Window");
}

void declare(CLI::App& app, ViewerChoice& choice) {
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  app.set_help_flag("-h,--help", "show this");
  choice.view.size = {kDefaultWidth, kDefaultHeight};
  cli::addSceneOptions(app, choice.scene);
  cli::addLightOptions(app, choice.light);
  cli::addViewOptions(app, choice.view);
  cli::addMoveOption(app, choice.moves);
  app.get_option("--size")
      ->description("of the window, in pixels")
      ->default_str(fmt::format("{}x{}", kDefaultWidth, kDefaultHeight));
  cli::addTechniqueOptions(app, choice.technique);
  cli::addSpheresOption(app, choice.spheres);
  cli::addDisplayOptions(app, choice.display);
  cli::addDeviceOption(app, choice.device);
  cli::addText(app, "--show", choice.show, "LAYER",
               "a layer or an image of the technique instead of the light");
  app.add_flag_callback(
      "--no-cache", [&choice] { choice.use_cache = false; }, "neither take nor keep a bake or spheres");
  addWindowOptions(app, choice);
  cli::addSettingsFile(app);
}

std::string vectorText(const glm::vec3& v) {
  return fmt::format("{},{},{}", v.x, v.y, v.z);
}

cli::Json ownType(const Pick& pick) {
  return cli::settingsJson(*pick.info, pick.settings);
}

}  // namespace

ViewerChoice parseArguments(const std::vector<std::string>& arguments, std::string* help) {
  auto choice = std::make_unique<ViewerChoice>();  // options keep its address
  CLI::App app("opens a scene in a window and lights it in real time", "gloam-view");
  declare(app, *choice);
  for (const std::string& argument : arguments) {
    if (argument.starts_with("--") && argument.find('=') == argument.size() - 1)
      throw Error(argument.substr(0, argument.size() - 1), "expected a value after '='");
  }
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());  // CLI11 takes them from the back
  try {
    app.parse(std::move(reversed));
    choice->scene_given = app.get_option("SCENE")->count() > 0;
  } catch (const CLI::CallForHelp&) {
    *help = app.help();
  } catch (const CLI::ParseError& error) {
    throw cli::usageError(app, error);
  }
  return std::move(*choice);
}

ViewerChoice readPreset(const std::string& file) {
  std::string unused;
  return parseArguments({"--settings", file}, &unused);
}

void writePreset(const std::string& file, const ViewState& state, const CameraControl& camera,
                 const std::string& environment, const std::vector<std::string>& lights) {
  cli::Json json;
  const int width = std::max(state.width, 1), height = std::max(state.height, 1);
  json["size"] = fmt::format("{}x{}", width, height);
  if (state.scene) {
    json["scene"] = wholeName(state.scene->name);
    if (state.scene->ground) json["ground"] = true;
    if (!state.scene->spheres.empty()) json["spheres"] = wholeName(state.scene->spheres);
    if (!state.moves.empty()) json["move"] = cli::moveTexts(state.scene->scene, state.moves);
  }
  if (!environment.empty()) json["env"] = wholeName(environment);
  json["env_rotation"] = cli::shortest(state.env_rotation_deg);
  json["env_intensity"] = cli::shortest(state.env_intensity);
  if (!lights.empty()) json["light"] = lights;
  json["eye"] = vectorText(camera.eye());
  json["target"] = vectorText(camera.target());
  if (camera.camera().perspective) {
    const float degrees = glm::degrees(camera.camera().vertical_fov_rad);
    json["fov"] = cli::shortest(std::clamp(degrees, 1.0f, 170.0f));
  } else {
    json["ortho"] = cli::shortest(2.0f * camera.camera().half_height);
  }
  json["time"] = cli::shortest(state.time_s);
  json["exposure"] = cli::shortest(state.display.exposure_stops);
  json["tone_map"] = state.display.tone_map == ToneMap::kAces ? "aces" : "none";
  json["background"] = state.background;
  if (state.supersample > 1) json["supersample"] = state.supersample;
  if (!state.show.empty()) json["show"] = state.show;
  json["technique"] = state.left.info->name;
  json[state.left.info->name] = ownType(state.left);
  const std::string text = cli::jsonText(json) + "\n";
  AtomicFile out(file);
  out.write(text.data(), text.size());
  out.commit();
}

}  // namespace gloam::view
