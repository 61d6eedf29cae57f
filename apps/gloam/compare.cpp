// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam compare: techniques beside the path-traced reference, as files, numbers and a page.
#include <fmt/core.h>

#include "compare_run.h"
#include "settings_file.h"
#include "spheres_run.h"
#include "verb.h"

namespace gloam::cli {
namespace {

std::string allTechniques() {
  std::vector<std::string> names;
  for (const TechniqueInfo& info : techniques()) names.emplace_back(info.name);
  return CLI::detail::join(names, ",");
}

void addCount(CLI::App& app, const std::string& name, std::optional<int>& value, Range range,
              const std::string& help, const std::string& shown_default) {
  const auto set = [&value, name, range](const std::string& text) {
    value = parseInteger(name, text, range);
  };
  app.add_option_function<std::string>(name, set, help)
      ->type_name("N")
      ->default_str(shown_default)
      ->group("Reference");
}

void addReferenceOptions(CLI::App& app, CompareChoice& choice) {
  addName(app, "--reference", choice.reference, "FILE",
          "an .exr of `gloam reference --parts`, of the same scene, light and camera; traced by default")
      ->group("Reference");
  addCount(app, "--bounces", choice.bounces, {0, 64}, "surfaces between the light and the one that is seen",
           "as many as the technique that has most");
  addCount(app, "--spp", choice.samples, {1, 1 << 24}, "paths a pixel; with --noise at most so many",
           "64; 65536 with --noise");
  const auto setNoise = [&choice](const std::string& text) {
    choice.noise = parseAboveZero("--noise", text);
  };
  app.add_option_function<std::string>(
         "--noise", setNoise,
         "go on until noise, an upper estimate, is this part of the picture's light (0.01: 1 %)")
      ->type_name("X")
      ->group("Reference");
  addCount(app, "--sh-order", choice.environment_order, {0, 6},
           "light the reference by the environment's N bands of spherical harmonics; 0: by its pixels",
           "0, or as a given reference was lit");
  addCount(app, "--seed", choice.seed, {0, 2147483647}, "of the reference's chance", "0");
}

std::function<int()> declareCompare(CLI::App& app, Console& console) {
  const auto choice = std::make_shared<CompareChoice>();
  addSceneOptions(app, choice->scene);
  addName(
      app, "--techniques", choice->techniques, "LIST",
      "what is compared: names apart by commas, each with :OPTION=VALUE as often as wanted; all: every one "
      "that can draw the scene")
      ->default_str(allTechniques());
  addOutput(app, choice->output, "FOLDER", "pictures, results and index.html; by default SCENE_compare");
  addReferenceOptions(app, *choice);
  addLightOptions(app, choice->light);
  addViewOptions(app, choice->view);
  app.get_option("--size")->default_str("512x512, or the reference's");
  addTechniqueOptions(app, choice->options);
  app.remove_option(app.get_option("--technique"));
  addDeviceOption(app, choice->device);
  addInteger(app, "--frames", choice->frames, {1, 100000}, "N", "timed for each, after two to warm up")
      ->default_str("20");
  const auto setExposure = [choice](const std::string& text) {
    choice->exposure_stops.reset();
    if (text == "auto") return;
    try {
      choice->exposure_stops = float(parseNumber("--exposure", text, {-8.0, 8.0}));
    } catch (const Error& error) {
      throw Error(std::string(error.what()) + ", or auto");
    }
  };
  app.add_option_function<std::string>("--exposure", setExposure, "stops with which the page begins")
      ->type_name("STOPS|auto")
      ->default_str("auto")
      ->group("Output");
  addSpheresOption(app, choice->spheres);
  app.add_flag("--no-cache{false}", choice->use_cache,
               "neither take nor keep the bake of a scene that has none");
  addConsoleOptions(app, console, true);
  addSettingsFile(app);
  return [choice, &app, &console] {
    choice->size_given = app.get_option("--size")->count() > 0;
    choice->supersample_given = app.get_option("--supersample")->count() > 0;
    return runCompare(*choice, console);
  };
}

}  // namespace

extern const Verb kCompareVerb;
const Verb kCompareVerb = {
    "compare", "holds techniques against the path-traced reference: pictures, errors, times, a page",
    "gloam compare builtin:columns --techniques irradiance,prt -o columns | all of it; open "
    "columns/index.html\n"
    "gloam compare bunny_prt.glb --env probe.exr --spp 256 -o bunny | a baked scene under a probe\n"
    "gloam compare bunny_prt.glb --techniques prt:order=2,prt:order=3,prt --sh-order 5 -o orders | error "
    "against time; the reference sees the same light as the technique\n"
    "gloam compare model.glb --reference truth.exr -o model | against a reference that is there already\n",
    declareCompare};

}  // namespace gloam::cli
