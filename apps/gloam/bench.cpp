// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam bench: how long the passes of a technique take.
#include <fmt/core.h>
#include <gloam/renderer.h>

#include <chrono>

#include "bake_run.h"
#include "bench_suites.h"
#include "scene_inputs.h"
#include "settings_file.h"
#include "spheres_run.h"
#include "technique_choice.h"
#include "timings.h"
#include "verb.h"

namespace gloam::cli {
namespace {

constexpr int kWarmUpFrames = 2;  // shaders are compiled and memory is first touched there

struct BenchChoice {
  std::string subject;  ///< a technique, or a suite of bench_suites.h
  SceneChoice scene{.name = "builtin:spheres"};
  LightChoice light;
  ViewChoice view{.size = {512, 512}};
  TechniqueChoice technique;
  std::string device;
  int frames = 20;
};

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

Timings measure(Renderer& renderer, const PosedScene& posed, const PosedCamera& camera,
                const RenderOptions& options, int frames, Console& console) {
  Timings timings;
  const Progress progress = console.progress();
  for (int i = -kWarmUpFrames; i < frames; ++i) {
    if (interrupted()) throw Interrupted("interrupted: no figures");
    progress.report(double(i + kWarmUpFrames) / double(frames + kWarmUpFrames), "bench");
    const auto started = std::chrono::steady_clock::now();
    const RenderedFrame frame = renderer.render(posed, camera, options);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - started;
    if (i >= 0) timings.add(frame, took.count());
    console.release();
  }
  console.endProgress();
  return timings;
}

int benchTechnique(const BenchChoice& choice, Console& console) {
  const TechniqueInfo& info = technique(choice.subject);
  Renderer renderer(choice.device);
  Scene scene = loadSceneToDraw(choice.scene, console);
  const Environment environment = chooseEnvironment(scene, choice.light, console);
  if (info.needs_bake && !carriesTransfer(scene)) {
    scene = bakeForDrawing(scene, choice.scene.name, choice.view.time_s, true, console);
  }
  renderer.setScene(scene);
  renderer.setEnvironment(environment);
  if (info.needs_spheres) {
    const int count = settingsFor(info, choice.technique).integer("spheres");
    renderer.setSpheres(scene, spheresForDrawing(scene, choice.scene.name, true, console, count));
  }
  const PosedScene posed = pose(scene, choice.view.time_s);
  RenderOptions options;
  options.width = choice.view.size.x, options.height = choice.view.size.y;
  options.supersample = choice.view.supersample;
  options.technique = info.name;
  options.settings = settingsFor(info, choice.technique);
  options.timings = true;
  options.layers = false;
  const PosedCamera camera = chooseCamera(posed, choice.view, console);
  const Timings timings = measure(renderer, posed, camera, options, choice.frames, console);
  checkValidation(renderer);

  const std::string size = fmt::format("{}x{}", options.width, options.height);
  if (console.json) {
    console.print(jsonText({{"device", renderer.device().name},
                            {"technique", info.name},
                            {"scene", choice.scene.name},
                            {"size", size},
                            {"frames", choice.frames},
                            {"passes", timings.passesJson()},
                            {"frame_ms", timings.medianFrameMs()},
                            {"memory_bytes", timings.memoryBytes()}}));
    return kDone;
  }
  console.print(fmt::format("{}, {}, {}, {} frames; {}; {} of device memory", info.name, choice.scene.name,
                            size, choice.frames, renderer.device().name,
                            bytesText(double(timings.memoryBytes()))));
  for (const std::string& line : timings.table()) console.print(line);
  return kDone;
}

int runBench(const BenchChoice& choice, Console& console) {
  if (const BenchSuite* suite = findSuite(choice.subject)) return suite->run(choice.scene.name, console);
  return benchTechnique(choice, console);
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
  addDeviceOption(app, choice->device);
  addLightOptions(app, choice->light);
  addViewOptions(app, choice->view);
  app.get_option("--size")->default_str("512x512");
  addTechniqueOptions(app, choice->technique);
  app.remove_option(app.get_option("--technique"));
  addConsoleOptions(app, console, true);
  addSettingsFile(app);
  return [choice, &console] { return runBench(*choice, console); };
}

}  // namespace

extern const Verb kBenchVerb;
const Verb kBenchVerb = {
    "bench", "measures: times of each pass, or of a part that runs on the CPU",
    "gloam bench prt builtin:cornell --size 1024x1024 | medians and 95th percentiles of each pass\n"
    "gloam bench irradiance model.glb --env probe.exr --frames 50 --json | for programs\n"
    "gloam bench sh | spherical harmonics: nanoseconds an operation, one thread\n"
    "gloam bench bake bunny.obj | the baker's rays a second beside those of the tracing library alone\n",
    declareBench};

}  // namespace gloam::cli
