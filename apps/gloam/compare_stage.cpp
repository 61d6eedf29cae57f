// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "compare_stage.h"

#include <fmt/core.h>
#include <gloam/volume.h>

#include <algorithm>
#include <chrono>

namespace gloam::cli {
namespace {

constexpr int kWarmUpFrames = 2;  // shaders are compiled and memory is first touched there

bool anyNeedsBake(const std::vector<Contender>& contenders) {
  return std::ranges::any_of(contenders, [](const Contender& c) { return c.technique->needs_bake; });
}

/// Bounces that a scene's transfer holds.
int bakedBounces(const Scene& scene) {
  int bounces = 0;
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.transfer)
      bounces = std::max(bounces, mesh.transfer->indirect.empty() ? 0 : mesh.transfer->bounces);
  }
  return bounces;
}

/// As many as the technique that has most of light that is there.
int chooseBounces(const CompareChoice& choice, const CompareStage& stage,
                  const std::vector<Contender>& contenders) {
  if (choice.bounces) return *choice.bounces;
  const int baked = carriesTransfer(stage.scene) ? bakedBounces(stage.scene) : BakeOptions{}.bounces;
  const Coverage any = lightIn(stage.scene, stage.posed, stage.environment, 1);
  int most = 0;
  for (const Contender& contender : contenders) {
    if (anyIndirect(both(coverageOf(contender), any))) most = std::max(most, bouncesOf(contender, baked));
  }
  return most;
}

}  // namespace

CompareStage prepareCompareStage(const CompareChoice& choice, std::vector<Contender>& contenders,
                                 std::optional<int> reference_bounces, Console& console) {
  CompareStage stage;
  stage.scene = loadSceneToDraw(choice.scene, console);
  if (carriesVolumes(stage.scene))
    throw Error(choice.scene.name,
                fmt::format("holds volumes ({}), which the path tracer does not know: there is "
                            "nothing to compare with",
                            volumeNames(stage.scene)));
  stage.environment = chooseEnvironment(stage.scene, choice.light, console, choice.view.time_s);
  stage.posed = pose(stage.scene, choice.view.time_s);
  stage.camera = chooseCamera(stage.posed, choice.view, console);
  remarkBuriedLamps(stage.scene, stage.posed, stage.camera, console);
  leaveOutUnbakeable(contenders, stage.scene, stage.posed, console);
  stage.bounces = reference_bounces.value_or(chooseBounces(choice, stage, contenders));
  stage.glowing = glowingInstances(stage.scene, stage.posed);
  stage.in_scene = lightIn(stage.scene, stage.posed, stage.environment, stage.bounces);
  leaveOutDark(contenders, stage.in_scene, console);
  for (const Contender& contender : contenders) requireLight(contender, stage.in_scene);
  return stage;
}

void bakeCompareStage(CompareStage& stage, const CompareChoice& choice,
                      const std::vector<Contender>& contenders, Console& console) {
  if (!anyNeedsBake(contenders)) return;
  if (carriesTransfer(stage.scene)) {
    stage.baked_bounces = bakedBounces(stage.scene);
    return;
  }
  stage.baked_bounces = std::min(stage.bounces, 64);
  BakeOptions options = drawingBake(stage.scene, choice.view.time_s, stage.baked_bounces);
  for (const Contender& contender : contenders) {
    if (!contender.technique->needs_bake || stage.bakeFor(contender) != nullptr) continue;
    options.apart = bakesApart(*contender.technique, contender.settings);
    CompareStage::Bake& bake = (options.apart ? stage.baked_apart : stage.baked).emplace();
    bake.scene =
        bakeForDrawing(stage.scene, choice.scene.name, options, choice.use_cache, console, &bake.time);
  }
}

const CompareStage::Bake* CompareStage::bakeFor(const Contender& contender) const {
  if (!contender.technique->needs_bake) return nullptr;
  const std::optional<Bake>& bake =
      bakesApart(*contender.technique, contender.settings) ? baked_apart : baked;
  return bake ? &*bake : nullptr;
}

Drawn drawContender(const CompareStage& stage, const CompareChoice& choice, const Contender& contender,
                    const ContenderSpheres& spheres, bool background, const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  const Scene& scene = stage.sceneFor(contender);
  const PosedScene posed = &scene == &stage.scene ? stage.posed : pose(scene, choice.view.time_s);
  Renderer renderer(choice.device);
  renderer.setScene(scene);
  renderer.setEnvironment(stage.environment);
  if (spheres.sets != nullptr) renderer.setSpheres(scene, *spheres.sets);
  if (spheres.sent != nullptr) renderer.setEmission(scene, *spheres.sent);
  RenderOptions options;
  options.width = choice.view.size.x, options.height = choice.view.size.y;
  options.supersample = choice.view.supersample;
  options.technique = contender.technique->name;
  options.settings = contender.settings;
  options.background = background;
  options.timings = true;
  options.layers = false;
  Drawn drawn;
  const int frames = kWarmUpFrames + choice.frames;
  for (int i = 0; i < frames; ++i) {
    if (progress.stopRequested()) throw Interrupted("interrupted");
    progress.report(double(i) / double(frames + 1), contender.label);
    const auto started = Clock::now();
    const RenderedFrame frame = renderer.render(posed, stage.camera, options);
    const std::chrono::duration<double, std::milli> took = Clock::now() - started;
    if (i >= kWarmUpFrames) drawn.timings.add(frame, took.count());
  }
  options.timings = false, options.layers = true;
  RenderedFrame picture = renderer.render(posed, stage.camera, options);
  checkValidation(renderer);
  drawn.picture = std::move(picture.layers);
  drawn.warnings = std::move(picture.warnings);
  drawn.device = renderer.device().name;
  return drawn;
}

}  // namespace gloam::cli
