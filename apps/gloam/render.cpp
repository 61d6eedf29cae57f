// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam render: a scene, light, a technique; a picture, frames or a video.
#include <fmt/core.h>
#include <gloam/renderer.h>
#include <renderer/proxy_set.h>

#include <optional>

#include "arguments.h"
#include "bake_run.h"
#include "display_choice.h"
#include "emission_run.h"
#include "frame_plan.h"
#include "node_moves.h"
#include "output.h"
#include "scene_inputs.h"
#include "scene_light.h"
#include "settings_file.h"
#include "show.h"
#include "spheres_overlay.h"
#include "spheres_run.h"
#include "technique_choice.h"
#include "timings.h"
#include "verb.h"

namespace gloam::cli {
namespace {

struct RenderChoice {
  SceneChoice scene;
  LightChoice light;
  ViewChoice view;
  std::vector<MoveText> moves;
  MotionChoice motion;
  TechniqueChoice technique;
  DisplayChoice display;
  std::string output, device, layer, spheres;
  bool use_cache = true;
};

std::string defaultOutput(const RenderChoice& choice) {
  return sceneStem(choice.scene.name) + (choice.motion.moves() ? ".mp4" : ".png");
}

/// All that a frame needs, apart from what moves.
struct Stage {
  Scene scene;
  NodeMoves moves;
  const TechniqueInfo* technique = nullptr;
  DistantLight base;  ///< light without --light
  PosedCamera camera;
  RenderOptions options;
};

Stage prepareStage(const RenderChoice& choice, float first_time_s, Console& console) {
  Stage stage;
  stage.scene = loadSceneToDraw(choice.scene, console);
  stage.moves = movesIn(stage.scene, choice.moves);
  stage.technique = &chooseTechnique(choice.technique, stage.scene);
  stage.options.settings = settingsFor(*stage.technique, choice.technique);
  stage.base = mapLight(chooseBaseEnvironment(stage.scene, choice.light, console));
  const PosedScene posed = pose(stage.scene, first_time_s);
  stage.camera = chooseCamera(posed, choice.view, console);
  remarkBuriedLamps(stage.scene, posed, stage.camera, console);
  if (choice.layer.empty()) {
    Coverage in_scene = lightIn(stage.scene, posed, *stage.base.map, 1);
    in_scene.environment_direct |= !choice.light.lights.empty();
    remarkDark(*stage.technique, stage.options.settings, in_scene, console);
  }
  if (choice.motion.animate && stage.scene.animations.empty() && !choice.light.lights.moves()) {
    console.remark("--animate: the scene holds no animation");
  }
  for (const auto& [name, values] : choice.technique.values) {
    if (name != stage.technique->name) {
      console.remark(fmt::format("options of {} have no effect on {}", name, stage.technique->name));
    }
  }
  if (stage.technique->needs_bake && !carriesTransfer(stage.scene)) {
    stage.scene = bakeForDrawing(stage.scene, choice.scene.name, first_time_s, choice.use_cache, console,
                                 bakesApart(*stage.technique, stage.options.settings));
    stage.moves = movesIn(stage.scene, choice.moves);  // copies that became nodes count, too
  }
  stage.options.width = choice.view.size.x;
  stage.options.height = choice.view.size.y;
  stage.options.supersample = choice.view.supersample;
  stage.options.technique = stage.technique->name;
  stage.options.background = choice.display.background;
  stage.options.layers = stage.options.parts =
      isFrameLayer(choice.layer) || (choice.layer.empty() && choice.output.ends_with(".exr"));
  if (!isFrameLayer(choice.layer)) stage.options.show = choice.layer;
  return stage;
}

void printResult(const RenderChoice& choice, const Stage& stage, const Renderer& renderer,
                 const Timings& timings, const DisplayOptions& display,
                 const std::vector<std::filesystem::path>& files, Console& console) {
  if (!console.json) {
    const std::string more = files.size() > 1 ? fmt::format(" to {}", files.back().filename().string()) : "";
    console.remark(fmt::format("wrote {}{} ({}, {}, {} a frame)", files.front().string(), more,
                               stage.technique->name, renderer.device().name,
                               durationText(timings.medianFrameMs() / 1000.0)));
    return;
  }
  Json outputs = Json::array();
  for (const auto& file : files) outputs.push_back(file.string());
  console.print(jsonText({{"scene", choice.scene.name},
                          {"environment", describedAt(stage.base, choice.light, choice.view.time_s).name},
                          {"technique", stage.technique->name},
                          {"settings", settingsJson(*stage.technique, stage.options.settings)},
                          {"device", renderer.device().name},
                          {"size", fmt::format("{}x{}", choice.view.size.x, choice.view.size.y)},
                          {"exposure_stops", display.exposure_stops},
                          {"outputs", outputs},
                          {"passes", timings.passesJson()},
                          {"frame_ms", timings.medianFrameMs()},
                          {"memory_bytes", timings.memoryBytes()}}));
}

int runRender(RenderChoice choice, Console& console) {
  if (choice.output.empty()) choice.output = defaultOutput(choice);
  refuseOverwriting(choice.output, choice.scene.name);
  refuseOverwriting(choice.output, choice.light.environment);
  const std::vector<PlannedFrame> frames = planFrames(choice.motion, choice.view.time_s);
  const auto output = openOutput({choice.output, frames.size(), choice.view.size.x, choice.view.size.y,
                                  choice.motion.frames_per_second, choice.layer});
  Renderer renderer(choice.device);
  Stage stage = prepareStage(choice, frames.front().time_s, console);
  stage.options.timings = console.json;
  renderer.setScene(stage.scene);
  SceneSpheres spheres;
  if (stage.technique->needs_spheres || showsSpheres(choice.layer)) {
    const int count =
        stage.technique->needs_spheres ? stage.options.settings.integer("spheres") : SphereOptions{}.count;
    spheres = spheresForDrawing(stage.scene, choice.scene.name, choice.use_cache, console, count, nullptr,
                                choice.spheres);
  }
  if (!choice.spheres.empty() && spheres.sets.empty())
    console.remark(fmt::format("--spheres: {} takes none", stage.technique->name));
  giveSpheres(renderer, *stage.technique, stage.scene, spheres, choice.scene.name, choice.use_cache, console);
  std::optional<ProxySet> drawn_in;
  if (choice.layer == kShadowSpheresLayer) drawn_in.emplace(stage.scene, spheres);

  DisplayOptions display = displayOf(choice.display);
  Timings timings;
  Warnings warned;
  const Progress progress = console.progress();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (interrupted()) {
      output->finish();
      throw Interrupted(fmt::format("interrupted; {} of {} frames are written", i, frames.size()));
    }
    progress.report(double(i) / double(frames.size()), fmt::format("frame {} of {}", i + 1, frames.size()));
    const PosedScene posed = poseMoved(stage.scene, stage.moves, frames[i].time_s);
    const PosedCamera camera = orbit(stage.camera, posed, frames[i].orbit_rad);
    if (i == 0 || choice.motion.turn_sky_deg != 0.0f || choice.light.lights.moves()) {
      DistantLight turned = stage.base;
      turned.rotation_rad += frames[i].sky_rad;
      renderer.setEnvironment(describedAt(turned, choice.light, frames[i].time_s));
    }
    const auto started = std::chrono::steady_clock::now();
    RenderedFrame frame = renderer.render(posed, camera, stage.options);
    timings.add(
        frame, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started).count());
    for (const std::string& warning : frame.warnings) {
      if (std::ranges::find(warned, warning) == warned.end()) console.remark(warned.emplace_back(warning));
    }
    holdExposure(display, frame.layers);
    if (showsSpheres(choice.layer)) {
      const std::vector<PosedSphere> shown =
          drawn_in ? drawn_in->drawnIn(posed) : poseSpheres(spheres, stage.scene, posed);
      frame.layers.add(choice.layer, {"R", "G", "B"}, spheresPicture(frame.layers, shown, camera, display));
    }
    output->write(frame.layers, display);
    console.release();
  }
  printResult(choice, stage, renderer, timings, display, output->finish(), console);
  checkValidation(renderer);
  return kDone;
}

std::function<int()> declareRender(CLI::App& app, Console& console) {
  const auto choice = std::make_shared<RenderChoice>();
  addSceneOptions(app, choice->scene);
  addOutput(app, choice->output, "FILE|FOLDER",
            "x.png, x.exr, x.hdr, x.mp4, x_####.png, or a folder of frames; by default the scene's name");
  addLightOptions(app, choice->light);
  addViewOptions(app, choice->view);
  addMoveOption(app, choice->moves);
  addMotionOptions(app, choice->motion);
  addSkyMotion(app, choice->motion);
  addTechniqueOptions(app, choice->technique);
  addSpheresOption(app, choice->spheres);
  addDeviceOption(app, choice->device);
  addDisplayOptions(app, choice->display);
  addText(app, "--show", choice->layer, CLI::detail::join(frameLayers(), "|") + "|NAME",
          "one layer of the frame instead of its light, or any image of the technique by name")
      ->group("Output");
  app.add_flag("--no-cache{false}", choice->use_cache,
               "neither take nor keep the bake or the spheres of a scene that has none");
  addConsoleOptions(app, console, true);
  addSettingsFile(app);
  return [choice, &console] { return runRender(*choice, console); };
}

}  // namespace

extern const Verb kRenderVerb;
const Verb kRenderVerb = {
    "render", "draws a scene and writes a picture, a folder of frames or a video",
    "gloam render builtin:cornell -o cornell.png | a built-in scene, with the defaults of everything\n"
    "gloam render model.glb --env probe.exr --exposure auto --supersample 2 -o model.png | a model under a "
    "light probe\n"
    "gloam render bunny.obj --ground --technique prt --env sky:noon -o bunny.png | soft shadows; bakes "
    "first, "
    "and keeps the bake\n"
    "gloam render model.glb --eye 2,1,3 --target 0,0.5,0 --fov 35 -o model.exr | another camera; linear "
    "light, all layers\n"
    "gloam render model.glb --orbit 48 --size 640x360 -o turn.mp4 | a turntable\n"
    "gloam render bunny_prt.glb --light 'disc?azimuth=0:0,4:360&radius=10' --animate 0:4 -o day.mp4 | a lamp "
    "from afar that goes round\n"
    "gloam render walk.glb --animate 0:4 --fps 30 -o frames | an animation as frames/frame_0000.png and so "
    "on\n",
    declareRender};

}  // namespace gloam::cli
