// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam reference: the truth about a scene, by paths.
#include <fmt/core.h>
#include <gloam/reference.h>
#include <gloam/volume.h>
#include <scene/coverage.h>

#include <cmath>

#include "display_choice.h"
#include "frame_plan.h"
#include "json.h"
#include "light_parts.h"
#include "node_moves.h"
#include "output.h"
#include "scene_inputs.h"
#include "scene_light.h"
#include "settings_file.h"
#include "verb.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kSamples = 64, kMostSamples = 65536;  // by default, without and with --noise
constexpr int kLargestSamples = 1 << 24;
constexpr double kMuchNoise = 0.2;  // errors of techniques are seldom larger

struct ReferenceChoice {
  SceneChoice scene;
  LightChoice light;
  LightParts parts;
  ViewChoice view;
  std::vector<MoveText> moves;
  MotionChoice motion;
  DisplayChoice display;
  ReferenceOptions options;
  int samples = 0;  ///< 0: not given
  float noise = 0.0f;
  int seed = 0;
  std::string output;
  bool separate = false, resume = true;
};

/// What all frames have in common.
struct Stage {
  Scene scene;
  NodeMoves moves;
  Environment environment;  ///< without --light
  std::string environment_name;
  LightChoice light;
  PosedCamera camera;
  ReferenceOptions options;
  ReferenceGoal goal;
};

/// Sums over frames; of samples and noise the most.
struct Total {
  int samples = 0;
  double noise = 0.0, seconds = 0.0;
  std::size_t rays = 0;
  bool resumed = false;
  std::string light, sources;  ///< as the picture's attributes name them
  void add(const LayeredImage& image, const ReferenceReport& report) {
    light = image.attributes.at("gloam.light");
    sources = image.attributes.at("gloam.sources");
    samples = std::max(samples, report.samples);
    noise = std::max(noise, report.noise);
    seconds += report.seconds;
    rays += report.rays;
    resumed |= report.resumed;
  }
  double raysPerSecond() const { return seconds > 0.0 ? double(rays) / seconds : 0.0; }
};

std::string noiseText(double noise) {
  if (!std::isfinite(noise)) return "not known";
  return noise < 0.1 ? fmt::format("{:.2g} %", 100.0 * noise) : fmt::format("{:.0f} %", 100.0 * noise);
}

// A sequence has none: its finished frames are there, the one in hand begins anew.
fs::path checkpointOf(const ReferenceChoice& choice, std::size_t frames) {
  if (frames > 1) return {};
  fs::path path = choice.output;
  if (!path.has_filename()) path = path.parent_path();
  return path += ".checkpoint";
}

std::string samplesText(int samples) {
  return samples == 1 ? "1 sample" : fmt::format("{} samples", samples);
}

ReferenceGoal goalOf(const ReferenceChoice& choice, const fs::path& checkpoint, Console& console) {
  ReferenceGoal goal;
  goal.noise = choice.noise;
  goal.samples = choice.samples > 0 ? choice.samples : choice.noise > 0.0f ? kMostSamples : kSamples;
  const int round = choice.view.supersample * choice.view.supersample;
  const int even = std::min((goal.samples + round - 1) / round * round, kLargestSamples / round * round);
  if (even != goal.samples) {
    console.remark(fmt::format("{} instead of {}: each of the {} positions in a pixel gets as many",
                               samplesText(even), goal.samples, round));
  }
  goal.samples = even;
  goal.checkpoint = checkpoint;
  return goal;
}

/// Light that was asked for by name and is not there is a slip: hours of black would be no answer.
void requireAskedLight(const ReferenceChoice& choice, const Stage& stage, const PlannedFrame& frame) {
  if (choice.parts.indirect && !choice.parts.direct && stage.options.bounces == 0)
    throw Error("--indirect", "without bounces there is no such light; expected --bounces 1 or more");
  if (choice.parts.only.empty()) return;
  const Coverage there =
      lightIn(stage.scene, poseMoved(stage.scene, stage.moves, frame.time_s),
              environmentAt(stage.environment, stage.light, frame.time_s), stage.options.bounces);
  if (both(there, stage.options.light) != Coverage{}) return;
  const std::vector<std::string> names = coverageNames(there);
  throw Error("--only", fmt::format("the scene has no light of {}; it has {}",
                                    CLI::detail::join(choice.parts.only, ", "),
                                    names.empty() ? "none at all" : CLI::detail::join(names, ", ")));
}

Stage prepareStage(const ReferenceChoice& choice, const std::vector<PlannedFrame>& frames, Console& console) {
  Stage stage;
  stage.scene = loadSceneToDraw(choice.scene, console);
  stage.moves = movesIn(stage.scene, choice.moves);
  if (carriesVolumes(stage.scene))
    console.remark(
        fmt::format("{} left out: paths know surfaces alone, no volumes", volumeNames(stage.scene)));
  stage.light = choice.light;
  stage.environment = chooseBaseEnvironment(stage.scene, choice.light, console);
  stage.environment_name = environmentAt(stage.environment, choice.light, frames.front().time_s).name;
  const PosedScene posed = pose(stage.scene, frames.front().time_s);
  stage.camera = chooseCamera(posed, choice.view, console);
  remarkBuriedLamps(stage.scene, posed, stage.camera, console);
  if (choice.motion.animate && stage.scene.animations.empty() && !choice.light.lights.moves()) {
    console.remark("--animate: the scene holds no animation");
  }
  stage.goal = goalOf(choice, checkpointOf(choice, frames.size()), console);
  stage.options = choice.options;
  stage.options.width = choice.view.size.x;
  stage.options.height = choice.view.size.y;
  stage.options.supersample = choice.view.supersample;
  stage.options.background = choice.display.background;
  stage.options.light = coverageOf(choice.parts);
  stage.options.seed = std::uint64_t(choice.seed);
  if (frames.size() == 1) requireAskedLight(choice, stage, frames.front());
  return stage;
}

/// Tells of one frame among many. Remarks are shown once samples come in: by then scene, options and checkpoint have
/// proved good.
Progress progressOf(std::size_t frame, std::size_t frames, Console& console) {
  Progress progress = console.progress();
  if (!progress.update) return progress;
  progress.update = [&console, frame, frames, update = progress.update](double fraction,
                                                                        const std::string& what) {
    if (what.find(" samples") != std::string::npos) console.release();
    const std::string text = frames > 1 ? fmt::format("frame {} of {}, {}", frame + 1, frames, what) : what;
    update((double(frame) + fraction) / double(frames), text);
  };
  return progress;
}

LayeredImage renderFrame(const Stage& stage, const PlannedFrame& frame, bool parts, const Progress& progress,
                         Total& total) {
  const PosedScene posed = poseMoved(stage.scene, stage.moves, frame.time_s);
  const PosedCamera camera = orbit(stage.camera, posed, frame.orbit_rad);
  const fs::path& checkpoint = stage.goal.checkpoint;
  ReferenceReport report;
  try {
    LayeredImage image = renderReference(stage.scene, posed, camera,
                                         environmentAt(stage.environment, stage.light, frame.time_s),
                                         stage.options, stage.goal, parts, progress, &report);
    total.add(image, report);
    return image;
  } catch (const Error& error) {
    const std::string text = error.what();
    if (checkpoint.empty() || !text.starts_with(checkpoint.string() + ":")) throw;
    throw Error(text.substr(0, text.find("; delete it")) + "; --no-resume starts anew");
  } catch (const Interrupted&) {
    std::error_code ignored;
    throw Interrupted(!checkpoint.empty() && fs::exists(checkpoint, ignored)
                          ? fmt::format("interrupted; the same command goes on from {}", checkpoint.string())
                          : "interrupted before anything was finished");
  }
}

void printResult(const ReferenceChoice& choice, const Stage& stage, const Total& total,
                 const std::vector<fs::path>& files, Console& console) {
  if (!console.json) {
    const std::string more = files.size() > 1 ? fmt::format(" to {}", files.back().filename().string()) : "";
    console.remark(fmt::format("wrote {}{} ({} a pixel, noise {}, {:.1f} Mrays/s, {}{})",
                               files.front().string(), more, samplesText(total.samples),
                               noiseText(total.noise), total.raysPerSecond() / 1e6,
                               durationText(total.seconds), total.resumed ? "; resumed" : ""));
    return;
  }
  Json outputs = Json::array();
  for (const fs::path& file : files) outputs.push_back(file.string());
  console.print(jsonText({{"scene", choice.scene.name},
                          {"environment", stage.environment_name},
                          {"environment_order", stage.options.environment_order},
                          {"light", total.light},
                          {"sources", total.sources},
                          {"bounces", stage.options.bounces},
                          {"size", fmt::format("{}x{}", stage.options.width, stage.options.height)},
                          {"supersample", stage.options.supersample},
                          {"seed", stage.options.seed},
                          {"samples", total.samples},
                          {"noise", total.noise},
                          {"rays", total.rays},
                          {"seconds", total.seconds},
                          {"rays_per_s", total.raysPerSecond()},
                          {"resumed", total.resumed},
                          {"outputs", outputs}}));
}

int runReference(ReferenceChoice choice, Console& console) {
  if (choice.output.empty()) {
    const char* end = !choice.motion.moves() ? "_reference.exr"
                      : choice.separate      ? "_reference_####.exr"
                                             : "_reference";
    choice.output = sceneStem(choice.scene.name) + end;
  }
  if (choice.separate && fs::path(choice.output).extension() != ".exr")
    throw Error("--parts",
                fmt::format("{} cannot hold layers; x.exr or x_####.exr was expected", choice.output));
  refuseOverwriting(choice.output, choice.scene.name);
  refuseOverwriting(choice.output, choice.light.environment);
  const std::vector<PlannedFrame> frames = planFrames(choice.motion, choice.view.time_s);
  const auto output = openOutput({choice.output, frames.size(), choice.view.size.x, choice.view.size.y,
                                  choice.motion.frames_per_second, ""});
  const Stage stage = prepareStage(choice, frames, console);
  std::error_code ignored;
  if (!choice.resume && !stage.goal.checkpoint.empty()) fs::remove(stage.goal.checkpoint, ignored);

  DisplayOptions display = displayOf(choice.display);
  Total total;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    try {
      const Progress progress = progressOf(i, frames.size(), console);
      const LayeredImage frame = renderFrame(stage, frames[i], choice.separate, progress, total);
      holdExposure(display, frame);
      output->write(frame, display);
      console.release();
    } catch (const Interrupted&) {
      if (i == 0) throw;
      output->finish();
      throw Interrupted(fmt::format("interrupted; {} of {} frames are written", i, frames.size()));
    }
  }
  if (total.sources == "none" && total.light != "none") {
    console.remark(
        fmt::format("nothing in the scene sends light of the kind that was asked for ({})", total.light));
  }
  if (choice.noise == 0.0f && std::isfinite(total.noise) && total.noise > kMuchNoise) {
    console.remark(
        fmt::format("a noise of {} leaves little to hold against: four times the samples (--spp) halve it",
                    noiseText(total.noise)));
  }
  printResult(choice, stage, total, output->finish(), console);
  if (choice.noise == 0.0f || total.noise <= double(choice.noise)) return kDone;
  console.remark(fmt::format("noise is still {} after {}; {} was asked for", noiseText(total.noise),
                             samplesText(total.samples), noiseText(double(choice.noise))));
  return kBoundExceeded;
}

void addPathOptions(CLI::App& app, ReferenceChoice& choice) {
  const auto add = [&app](const char* name, int& value, Range range, const char* help) {
    return addInteger(app, name, value, range, "N", help)->group("Paths");
  };
  add("--bounces", choice.options.bounces, {0, 1000},
      "surfaces between the first light met and the one that is seen; 0: direct light alone")
      ->default_str(std::to_string(choice.options.bounces));
  add("--spp", choice.samples, {1, kLargestSamples},
      "samples a pixel; with --noise: at most (default: 64, with --noise 65536)");
  const auto setNoise = [&choice](const std::string& text) {
    choice.noise = parseAboveZero("--noise", text);
  };
  app.add_option_function<std::string>(
         "--noise", setNoise,
         "go on until the picture's standard error, an upper estimate, is this part of its mean: 0.01 is 1 %")
      ->type_name("X")
      ->group("Paths");
  add("--sh-order", choice.options.environment_order, {0, 6},
      "light from far away as its projection to N bands of spherical harmonics; 0: its pixels")
      ->default_str("0");
  add("--seed", choice.seed, {0, 2147483647}, "another picture of the same noise")->default_str("0");
  add("--threads", choice.options.threads, {0, 1024}, "0: all cores; the picture is the same")
      ->default_str("0");
}

std::function<int()> declareReference(CLI::App& app, Console& console) {
  const auto choice = std::make_shared<ReferenceChoice>();
  addSceneOptions(app, choice->scene);
  addOutput(
      app, choice->output, "FILE|FOLDER",
      "x.exr, x.png, x.hdr, x.mp4, x_####.exr, or a folder; by default the scene's name and _reference.exr");
  addPathOptions(app, *choice);
  addLightOptions(app, choice->light);
  addLightParts(app, choice->parts);
  addViewOptions(app, choice->view);
  addMoveOption(app, choice->moves);
  addMotionOptions(app, choice->motion);
  addDisplayOptions(app, choice->display);
  app.add_flag("--parts", choice->separate,
               "one more layer of the .exr for each source and path; x.exr or x_####.exr alone")
      ->group("Output");
  app.add_flag("--resume,!--no-resume", choice->resume,
               "go on from an interrupted run of the same output, or start anew [on]");
  addConsoleOptions(app, console, true);
  addSettingsFile(app);
  return [choice, &console] { return runReference(*choice, console); };
}

}  // namespace

extern const Verb kReferenceVerb;
const Verb kReferenceVerb = {
    "reference", "traces paths: the truth that techniques are held against",
    "gloam reference builtin:cornell --bounces 8 --spp 256 -o cornell.exr | all light, all layers, variance\n"
    "gloam reference model.glb --env probe.exr --noise 0.01 --parts -o model.exr | until noise is 1 %; light "
    "by "
    "source\n"
    "gloam reference bunny.obj --ground --env sky:noon --only environment --direct --sh-order 5 -o bunny.exr "
    "| "
    "what a technique covers, and no more\n"
    "gloam reference model.glb --spp 4096 -o model.exr | after Ctrl-C the same command goes on where it "
    "stopped\n",
    declareReference};

}  // namespace gloam::cli
