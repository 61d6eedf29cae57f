// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bench_stage.h"

#include <fmt/core.h>

#include <chrono>
#include <ctime>

#include "bake_run.h"
#include "emission_run.h"
#include "spheres_run.h"

namespace gloam::cli {

BenchStage prepareBench(const BenchChoice& choice, Console& console) {
  const TechniqueInfo& info = technique(choice.subject);
  BenchStage stage{.renderer = Renderer(choice.device)};
  stage.scene = loadSceneToDraw(choice.scene, console);
  stage.environment = chooseEnvironment(stage.scene, choice.light, console);
  stage.options.settings = settingsFor(info, choice.technique);
  if (info.needs_bake && !carriesTransfer(stage.scene)) {
    stage.scene = bakeForDrawing(stage.scene, choice.scene.name, choice.view.time_s, true, console,
                                 bakesApart(info, stage.options.settings));
  }
  stage.renderer.setScene(stage.scene);
  stage.renderer.setEnvironment(stage.environment);
  if (!choice.spheres.empty() && !info.needs_spheres)
    console.remark(fmt::format("--spheres: {} takes none", info.name));
  if (info.needs_spheres) {
    stage.spheres = spheresForDrawing(stage.scene, choice.scene.name, true, console,
                                      stage.options.settings.integer("spheres"), nullptr, choice.spheres);
    giveSpheres(stage.renderer, info, stage.scene, stage.spheres, choice.scene.name, true, console);
  }
  stage.posed = pose(stage.scene, choice.view.time_s);
  stage.options.width = choice.view.size.x, stage.options.height = choice.view.size.y;
  stage.options.supersample = choice.view.supersample;
  stage.options.technique = info.name;
  stage.options.timings = true;
  stage.options.layers = stage.options.parts = false;
  stage.camera = chooseCamera(stage.posed, choice.view, console);
  return stage;
}

double drawTimed(BenchStage& stage, const RenderOptions& options, Timings& timings) {
  const auto started = std::chrono::steady_clock::now();
  const std::clock_t cpu_started = std::clock();
  const RenderedFrame frame = stage.renderer.render(stage.posed, stage.camera, options);
  const double cpu_ms = 1e3 * double(std::clock() - cpu_started) / CLOCKS_PER_SEC;
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - started;
  timings.add(frame, took.count(), cpu_ms);
  return took.count();
}

std::string benchCommand(const BenchChoice& choice, const char* option) {
  return fmt::format("gloam bench {} {} {} --size {}x{} --frames {}", choice.subject,
                     shellWord(choice.scene.name), option, choice.view.size.x, choice.view.size.y,
                     choice.frames);
}

}  // namespace gloam::cli
