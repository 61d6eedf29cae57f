// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Guerrero, Jeschke, Wimmer 2008, "Real-time indirect illumination and soft shadows in dynamic scenes using spherical lights", section
// 8.5: four scenes made again in kind, rates of both ways of blocking and of shadows alone (GeForce 8800GTX, light at vertices, column
// "p.s."). Here ratios of times, all sides in turn in one run.
#include <fmt/core.h>
#include <gloam/metrics.h>

#include "bench_paper.h"
#include "bench_scaling.h"
#include "emission_run.h"

namespace gloam::cli {
namespace {

using Better = PaperRow::Better;

/// A scene of the paper, its frames a second, and its data.
struct PaperScene {
  const char *name, *spheres;
  double per_sphere, per_object, shadows, kilobytes;
};
constexpr PaperScene kScenes[] = {{"builtin:squirrel", "14", 26, 35, 174, 1090},
                                  {"builtin:robot", "26", 12, 20, 97, 1180},
                                  {"builtin:packages", "16", 30, 43, 190, 920},
                                  {"builtin:assembly", "38", 8, 14, 90, 1120}};
constexpr double kTableKilobytes = (12 * 3 * 16 + 92 * 16 * 4) / 1024.0;

struct Variant {
  const char* name;
  std::vector<std::pair<const char*, const char*>> settings;
};
enum { kObject, kSphere, kSphereAgain, kShadows, kFlats, kHierarchy, kVertices, kVariants };
/// As the paper has it, ground and walls send nothing, but for the last.
const std::vector<Variant>& variants() {
  static const std::vector<Variant> list = {
      {"per object", {{"flats", "false"}}},
      {"per sphere", {{"flats", "false"}, {"blocking", "per_sphere"}}},
      {"per sphere, nothing reused", {{"flats", "false"}, {"blocking", "per_sphere"}, {"reuse", "false"}}},
      {"shadows alone", {{"flats", "false"}, {"indirect", "false"}}},
      {"per object, with ground and walls", {}},
      {"per object, hierarchy", {{"flats", "false"}, {"hierarchy", "0.4"}}},
      {"per object, at vertices", {{"flats", "false"}, {"receivers", "vertices"}}}};
  return list;
}

/// What finds the light, in milliseconds.
double lightTime(const std::vector<PassTime>& passes) {
  double time = 0.0;
  for (const PassTime& pass : passes) {
    if (pass.name.starts_with("spherical_lights.") || pass.name.starts_with("frame.receivers") ||
        pass.name == "frame.upsample")
      time += pass.milliseconds;
  }
  return time;
}

struct Times {
  std::vector<double> of[kVariants];
  double ratio(int over, int under) const {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < of[over].size(); ++i)
      ratios.push_back(of[over][i] / std::max(1e-9, of[under][i]));
    return quantile(ratios, 0.5);
  }
  double median(int variant) const { return quantile(of[variant], 0.5); }
};

Times measureScene(BenchStage& stage, int rounds, const std::string& name, Console& console) {
  Times times;
  const Progress progress = console.progress();
  for (int round = -1; round < rounds; ++round) {  // one to warm up
    for (int v = 0; v < kVariants; ++v) {
      if (interrupted()) throw Interrupted("interrupted: no figures");
      progress.report((double(round + 1) + double(v) / double(kVariants)) / double(rounds + 1), name);
      RenderOptions options = stage.options;
      for (const auto& [option, value] : variants()[std::size_t(v)].settings)
        options.settings.set(option, value);
      const RenderedFrame frame = stage.renderer.render(stage.posed, stage.camera, options);
      if (round >= 0) times.of[v].push_back(lightTime(frame.passes));
    }
  }
  console.endProgress();
  checkValidation(stage.renderer);
  return times;
}

void addScene(PaperTable& table, const BenchChoice& asked, const PaperScene& scene, Console& console) {
  BenchChoice choice = asked;
  choice.scene = {.name = scene.name};
  choice.technique.values["spherical_lights"].try_emplace("spheres", scene.spheres);
  BenchStage stage = prepareBench(choice, console);
  console.release();
  table.device = stage.renderer.device().name;
  const std::size_t bytes = emissionForDrawing(stage.scene, stage.spheres, scene.name, true, console).bytes();
  const Times times = measureScene(stage, choice.frames, scene.name, console);
  const std::string name = scene.name;
  const auto add = [&](const std::string& what, double ours, std::optional<double> paper, const char* unit,
                       Better better) {
    table.rows.push_back({name + ": " + what, ours, paper, unit, better});
  };
  add("spheres", double(stage.spheres.count()), std::stod(scene.spheres), "spheres", Better::kNone);
  add("speed of per object over per sphere, nothing reused as in the paper",
      times.ratio(kSphereAgain, kObject), scene.per_object / scene.per_sphere, "ratio", Better::kHigher);
  add("the same where per sphere reuses sums", times.ratio(kSphere, kObject), std::nullopt, "ratio",
      Better::kNone);
  add("time with indirect light over shadows alone, per object", times.ratio(kObject, kShadows),
      scene.shadows / scene.per_object, "ratio", Better::kLower);
  add("the same, per sphere", times.ratio(kSphere, kShadows), scene.shadows / scene.per_sphere, "ratio",
      Better::kLower);
  add("time with ground and walls over without", times.ratio(kFlats, kObject), std::nullopt, "ratio",
      Better::kNone);
  add("time with hierarchy 0.4 over without", times.ratio(kHierarchy, kObject), std::nullopt, "ratio",
      Better::kNone);
  add("time at vertices over at pixels", times.ratio(kVertices, kObject), std::nullopt, "ratio",
      Better::kNone);
  add("light alone, per object", times.median(kObject), 1e3 / scene.per_object, "ms", Better::kNone);
  add("samples and albedos of all objects, tables", double(bytes) / 1024.0 + kTableKilobytes, scene.kilobytes,
      "KB", Better::kLower);
}

/// Time over the number of balls, each an object of one sphere, in 64 x 64 receivers: the paper's per sphere grows with their square,
/// per object with their number.
void addGrowth(PaperTable& table, const BenchChoice& choice, Console& console) {
  struct Way {
    const char* name;
    int variant;
    double paper;
  };
  Renderer renderer(choice.device);
  RenderOptions options{.width = 256, .height = 256, .timings = true};
  options.layers = options.parts = false;
  options.technique = "spherical_lights";
  table.plot = {.title = "Time of light over the number of balls",
                .across = "balls, an object and a sphere each",
                .up = "milliseconds",
                .notes = {fmt::format("{}, 64x64 receivers", table.device)}};
  for (const Way& way : {Way{"per object", kObject, 4.0}, Way{"per sphere", kSphere, 16.0},
                         Way{"per sphere, nothing reused", kSphereAgain, 16.0}}) {
    options.settings = settingsFor(technique(options.technique), choice.technique);
    for (const auto& [option, value] : variants()[std::size_t(way.variant)].settings)
      options.settings.set(option, value);
    const std::vector<ScalingPoint> points = measureScaling(renderer, options, choice.frames, console);
    PlotCurve curve{way.name, {}};
    table.plot.places.clear();
    for (const ScalingPoint& point : points) {
      table.plot.places.push_back(point.count);
      curve.values.push_back(point.light_ms);
    }
    table.plot.curves.push_back(curve);
    const ScalingPoint &few = points[points.size() - 3], &many = points.back();
    table.rows.push_back({fmt::format("time of {} balls over {}, {}", many.count, few.count, way.name),
                          many.light_ms / few.light_ms, way.paper, "ratio", Better::kLower});
  }
}

}  // namespace

PaperTable measureSphericalLightsPaper(const BenchChoice& choice, Console& console) {
  PaperTable table;
  for (const PaperScene& scene : kScenes) addScene(table, choice, scene, console);
  table.rows.push_back({"tables of the technique", kTableKilobytes, 775.0, "KB", Better::kLower});
  addGrowth(table, choice, console);
  table.notes = {fmt::format("{}x{}, {} rounds; a ratio is the median over rounds of times by the passes' "
                             "own timers, of what finds the "
                             "light; the paper's rates are of whole frames on a GeForce 8800GTX.",
                             choice.view.size.x, choice.view.size.y, choice.frames),
                 "The scenes are made again in kind, with as many spheres as the paper's where their shapes "
                 "allow; its data took "
                 "32 to 150 KB an object."};
  return table;
}

}  // namespace gloam::cli
