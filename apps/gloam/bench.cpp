// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam bench: how long the passes of a technique take.
#include <fmt/core.h>

#include "bench_figures.h"
#include "bench_paper.h"
#include "bench_scaling.h"
#include "bench_stage.h"
#include "bench_suites.h"
#include "settings_file.h"
#include "spheres_run.h"
#include "verb.h"

namespace gloam::cli {
namespace {

std::string listedSubjects() {
  std::vector<std::string> names;
  for (const TechniqueInfo& info : techniques()) names.emplace_back(info.name);
  for (const BenchSuite& suite : benchSuites()) names.emplace_back(suite.name);
  return listed(names);
}

const BenchSuite* findSuite(const std::string& name) {
  for (const BenchSuite& suite : benchSuites()) {
    if (name == suite.name) return &suite;
  }
  return nullptr;
}

Timings measure(BenchStage& stage, int frames, float orbit_step_deg, Console& console) {
  Timings timings, warm_up;
  const PosedCamera first = stage.camera;
  const Progress progress = console.progress();
  for (int i = -kWarmUpFrames; i < frames; ++i) {
    if (interrupted()) throw Interrupted("interrupted: no figures");
    progress.report(double(i + kWarmUpFrames) / double(frames + kWarmUpFrames), "bench");
    stage.camera = orbit(first, stage.posed, glm::radians(orbit_step_deg * float(i)));
    drawTimed(stage, stage.options, i < 0 ? warm_up : timings);
    console.release();
  }
  console.endProgress();
  return timings;
}

int benchTechnique(const BenchChoice& choice, Console& console) {
  BenchStage stage = prepareBench(choice, console);
  const Timings timings = measure(stage, choice.frames, choice.orbit_step_deg, console);
  checkValidation(stage.renderer);

  const std::string size = fmt::format("{}x{}", stage.options.width, stage.options.height);
  const std::string device = stage.renderer.device().name;
  if (console.json) {
    console.print(jsonText({{"device", device},
                            {"technique", choice.subject},
                            {"scene", choice.scene.name},
                            {"size", size},
                            {"frames", choice.frames},
                            {"passes", timings.passesJson()},
                            {"frame_ms", timings.medianFrameMs()},
                            {"cpu_ms", timings.medianCpuMs()},
                            {"memory_bytes", timings.memoryBytes()}}));
    return kDone;
  }
  console.print(fmt::format("{}, {}, {}, {} frames; {}; {} of device memory", choice.subject,
                            choice.scene.name, size, choice.frames, device,
                            bytesText(double(timings.memoryBytes()))));
  for (const std::string& line : timings.table()) console.print(line);
  return kDone;
}

/// What --paper and --scaling measure where nothing else is said.
void chooseDefaults(BenchChoice& choice, const CLI::App& app) {
  if (choice.paper && app.get_option("SCENE")->empty())
    choice.scene.name = choice.subject == "splatting" ? "builtin:swing" : "builtin:walker";
  if (choice.paper && choice.subject == "radiance_filter") {
    // Lit by what glows in it; brute force at every pixel takes its time.
    if (app.get_option("SCENE")->empty()) {
      choice.scene.name = "builtin:bumps";
      if (choice.light.environment.empty()) choice.light.environment = "none";
    }
    if (app.get_option("--size")->empty()) choice.view.size = {192, 144};
    return;
  }
  if (!choice.figures.empty() && app.get_option("--size")->empty()) choice.view.size = {320, 320};
  if ((choice.paper || choice.scaling) && app.get_option("--size")->empty()) choice.view.size = {1024, 1024};
}

int runBench(BenchChoice choice, const CLI::App& app, Console& console) {
  chooseDefaults(choice, app);
  const BenchSuite* suite = findSuite(choice.subject);
  if (choice.paper && choice.scaling) throw Error("--paper", "and --scaling: one at a time");
  if (suite != nullptr && (choice.paper || choice.scaling))
    throw Error(choice.paper ? "--paper" : "--scaling", fmt::format("'{}' is no technique", choice.subject));
  if (choice.scaling && !app.get_option("SCENE")->empty())
    throw Error("--scaling", fmt::format("measures a scene of its own; not {}", choice.scene.name));
  if (!choice.spheres.empty() && (choice.scaling || !choice.figures.empty()))
    throw Error("--spheres", "are a given scene's; --scaling and --figures measure scenes of their own");
  if (!choice.output.empty() && !choice.paper && !choice.scaling)
    throw Error("--output", "is a plot, which --paper and --scaling draw");
  if (choice.orbit_step_deg != 0.0f && (choice.paper || choice.scaling || !choice.figures.empty()))
    throw Error("--orbit-step", "is of plain measurements, not of --paper, --scaling or --figures");
  if (suite != nullptr) refuseUnused(*suite, app);
  if (!choice.figures.empty() && (choice.paper || choice.scaling || !app.get_option("SCENE")->empty()))
    throw Error("--figures", "draws scenes of its own, and not beside --paper or --scaling");
  if (!choice.figures.empty()) return benchFigures(choice, console);
  if (choice.paper) return benchPaper(choice, console);
  if (choice.scaling) return benchScaling(choice, console);
  return suite != nullptr ? suite->run(choice, console) : benchTechnique(choice, console);
}

std::function<int()> declareBench(CLI::App& app, Console& console) {
  const auto choice = std::make_shared<BenchChoice>();
  choice->subject = "irradiance";
  const auto setSubject = [choice](const std::string& text) {
    const bool known =
        findSuite(text) != nullptr ||
        std::ranges::any_of(techniques(), [&](const TechniqueInfo& info) { return text == info.name; });
    if (!known)
      throw Error("TECHNIQUE",
                  fmt::format("nothing to measure is called '{}'; expected {}", text, listedSubjects()));
    choice->subject = text;
  };
  app.add_option_function<std::string>("TECHNIQUE", setSubject,
                                       fmt::format("what is measured: {}", listedSubjects()))
      ->type_name("SUBJECT")
      ->default_str(choice->subject);
  addSceneOptions(app, choice->scene);
  addInteger(app, "--frames", choice->frames, {1, 100000}, "N", "measured, after two to warm up")
      ->default_str("20");
  addNumber(app, "--orbit-step", choice->orbit_step_deg, {-360.0f, 360.0f}, "DEG",
            "the camera turns so far about the scene from frame to frame; what lamps alone see is kept then, "
            "as in use; "
            "0: all of every frame is drawn anew")
      ->default_str("0");
  app.add_flag("--paper", choice->paper,
               fmt::format("the figures of the technique's paper, ours beside theirs ({})",
                           listed(techniquesWithPaper())));
  app.add_flag("--scaling", choice->scaling, "time over the number of spheres, 10 to 2,000 (proxies)");
  app.add_option(
         "--figures", choice->figures,
         "a folder: the experiments of the paper against the reference, with pictures (spherical_lights)")
      ->type_name("DIR");
  addSpheresOption(app, choice->spheres);
  addOutput(app, choice->output, "FILE", "plot of --paper or --scaling: x.svg or x.csv");
  addDeviceOption(app, choice->device);
  addLightOptions(app, choice->light);
  addViewOptions(app, choice->view);
  app.get_option("--size")->default_str("512x512");
  addTechniqueOptions(app, choice->technique);
  app.remove_option(app.get_option("--technique"));
  addConsoleOptions(app, console, true);
  addSettingsFile(app);
  return [choice, &app, &console] { return runBench(*choice, app, console); };
}

}  // namespace

extern const Verb kBenchVerb;
const Verb kBenchVerb = {
    "bench", "measures: times of each pass, or of a part that runs on the CPU",
    "gloam bench prt builtin:cornell --size 1024x1024 | medians and 95th percentiles of each pass\n"
    "gloam bench irradiance model.glb --env probe.exr --frames 50 --json | for programs\n"
    "gloam bench proxies --paper -o operators.svg | the paper's figures, ours beside them; a plot\n"
    "gloam bench spherical_lights --figures figures | the experiments of the paper, errors and differences\n"
    "gloam bench sh | spherical harmonics: nanoseconds an operation, one thread\n"
    "gloam bench bake bunny.obj | the baker's rays a second beside those of the tracing library alone\n"
    "gloam bench gloss builtin:bronze --env sky:mild | shadowed gloss against plain integrals\n",
    declareBench};

}  // namespace gloam::cli
