// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nichols, Wyman 2009, "Multiresolution splatting for indirect illumination": table 1, figures 7 to 9. Rates there (GeForce
// GTX 280); here ratios of times, all variants of a scene in turn in one run, in the scene that is asked for and in four scenes
// like the paper's.
#include <fmt/core.h>
#include <gloam/metrics.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bench_paper.h"

namespace gloam::cli {
namespace {

using Better = PaperRow::Better;

struct Variant {
  std::string name;
  std::vector<std::pair<std::string, std::string>> settings;
};

/// The paper's own ways: no word of the light's change, no merged lights, its upsampling, a grid of 16 by 16 lights; by compute
/// passes, whatever the size.
Variant asPaper(const std::string& name, std::vector<std::pair<std::string, std::string>> settings) {
  settings.insert(settings.begin(), {{"gather", "device"},
                                     {"light_threshold", "0"},
                                     {"cluster_threshold", "0"},
                                     {"upsample", "paper"},
                                     {"vpls", "256"},
                                     {"normal_threshold", "0.5"}});
  return {name, settings};
}

/// Passes after the reflective shadow maps and the G-buffer.
double ownTime(const std::vector<PassTime>& passes) {
  double sum = 0.0;
  for (const PassTime& pass : passes) {
    if (pass.name.starts_with("splatting.") || pass.name.starts_with("frame.receivers"))
      sum += pass.milliseconds;
  }
  return sum;
}

/// Times and light of all variants in one scene.
struct Rounds {
  std::vector<Variant> variants;
  std::vector<std::vector<double>> own;
  std::vector<Image> light;

  std::size_t at(const std::string& name) const {
    for (std::size_t i = 0; i < variants.size(); ++i) {
      if (variants[i].name == name) return i;
    }
    return 0;
  }
  /// Median over rounds of one variant's time over another's.
  double ratio(const std::string& over, const std::string& under) const {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < own[at(over)].size(); ++i)
      ratios.push_back(own[at(over)][i] / std::max(1e-9, own[at(under)][i]));
    return quantile(ratios, 0.5);
  }
  /// %; against the full sum over as many lights.
  double error(const std::string& name, const std::string& full) const {
    return std::sqrt(relativeSquaredError(light[at(name)], light[at(full)])) * 100.0;
  }
};

Rounds measureRounds(BenchStage& stage, const std::string& scene, std::vector<Variant> variants, int frames,
                     Console& console) {
  Rounds rounds{std::move(variants), {}, {}};
  const std::size_t count = rounds.variants.size();
  rounds.own.resize(count);
  rounds.light.resize(count);
  const Progress progress = console.progress();
  for (int round = -1; round < frames; ++round) {  // one to warm up
    for (std::size_t v = 0; v < count; ++v) {
      if (interrupted()) throw Interrupted("interrupted: no figures");
      progress.report((double(round + 1) + double(v) / double(count)) / double(frames + 1),
                      scene + ", " + rounds.variants[v].name);
      RenderOptions options = stage.options;
      for (const auto& [name, value] : rounds.variants[v].settings) options.settings.set(name.c_str(), value);
      options.parts = round < 0;
      const RenderedFrame frame = stage.renderer.render(stage.posed, stage.camera, options);
      if (round >= 0) rounds.own[v].push_back(ownTime(frame.passes));
      if (round < 0) rounds.light[v] = frame.layers.image("indirect", {"R", "G", "B"}, "frame");
    }
  }
  console.endProgress();
  return rounds;
}

Rounds measureScene(const BenchChoice& asked, const std::string& scene, std::vector<Variant> variants,
                    PaperTable& table, Console& console) {
  BenchChoice choice = asked;
  choice.scene = {.name = scene};
  BenchStage stage = prepareBench(choice, console);
  if (stage.posed.lights.empty()) throw Error(scene, "--paper needs lamps, such as those of builtin:swing");
  console.release();
  table.device = stage.renderer.device().name;
  return measureRounds(stage, scene, std::move(variants), choice.frames, console);
}

constexpr const char* kSizes[] = {"128", "256", "512", "1024"};

/// Table 1: frames a second at four sizes of the indirect light.
struct PaperScene {
  const char *name, *like;
  double rates[4];
};
constexpr PaperScene kScenes[] = {{"builtin:teapot", "teapot", {68, 50, 33, 22}},
                                  {"builtin:statue", "spinning Buddha", {60, 42, 30, 24}},
                                  {"builtin:serpent", "dragon and bunny", {59, 42, 28, 21}},
                                  {"builtin:flying", "flying bunnies", {52, 41, 31, 25}}};

void addTable1(PaperTable& table, const BenchChoice& choice, Console& console) {
  for (const PaperScene& scene : kScenes) {
    std::vector<Variant> variants;
    for (const char* size : kSizes) variants.push_back(asPaper(size, {{"resolution", size}}));
    variants.push_back({"default", {}});
    variants.push_back({"passes", {{"gather", "device"}}});
    variants.push_back({"full", {{"mode", "full"}}});
    const Rounds rounds = measureScene(choice, scene.name, variants, table, console);
    for (int i = 0; i < 3; ++i)
      table.rows.push_back(
          {fmt::format("{} ({}): time at {} over that at 1024", scene.name, scene.like, kSizes[i]),
           rounds.ratio(kSizes[i], "1024"), scene.rates[3] / scene.rates[i], "ratio", Better::kNone});
    table.rows.push_back({fmt::format("{}: defaults, faster than full resolution", scene.name),
                          rounds.ratio("full", "default"), std::nullopt, "ratio", Better::kNone});
    table.rows.push_back({fmt::format("{}: by compute passes, faster than full resolution", scene.name),
                          rounds.ratio("full", "passes"), std::nullopt, "ratio", Better::kNone});
    table.rows.push_back({fmt::format("{}: defaults, relative RMSE against it", scene.name),
                          rounds.error("default", "full"), std::nullopt, "%", Better::kNone});
  }
}

/// The same model and camera at four numbers of triangles, a frame of each in turn.
void addTriangles(PaperTable& table, const BenchChoice& asked, Console& console) {
  constexpr const char* kTriangles[] = {"11000", "48000", "203000", "871000"};
  std::vector<std::unique_ptr<BenchStage>> stages;
  for (const char* triangles : kTriangles) {
    BenchChoice choice = asked;
    choice.scene = {.name = fmt::format("builtin:statue?triangles={}", triangles)};
    stages.emplace_back(new BenchStage(prepareBench(choice, console)));
  }
  console.release();
  std::vector<std::vector<double>> ratios(stages.size());
  const Progress progress = console.progress();
  for (int round = -1; round < asked.frames; ++round) {  // one to warm up
    double first = 0.0;
    for (std::size_t i = 0; i < stages.size(); ++i) {
      if (interrupted()) throw Interrupted("interrupted: no figures");
      progress.report((double(round + 1) + double(i) / double(stages.size())) / double(asked.frames + 1),
                      fmt::format("statue of {} triangles", kTriangles[i]));
      BenchStage& stage = *stages[i];
      const double time = ownTime(stage.renderer.render(stage.posed, stage.camera, stage.options).passes);
      if (i == 0) first = time;
      if (round >= 0) ratios[i].push_back(time / std::max(1e-9, first));
    }
  }
  console.endProgress();
  for (std::size_t i = 0; i < stages.size(); ++i)
    table.rows.push_back(
        {fmt::format("statue of {} triangles: time over that of {}", kTriangles[i], kTriangles[0]),
         quantile(ratios[i], 0.5), std::nullopt, "ratio", Better::kNone});
}

constexpr const char* kThresholds[] = {"0.05", "0.1", "0.2", "0.5", "1", "1.5"};

std::vector<Variant> sweeps() {
  std::vector<Variant> list = {{"default", {{"vpls", "256"}}},
                               {"passes", {{"vpls", "256"}, {"gather", "device"}}},
                               {"full", {{"vpls", "256"}, {"mode", "full"}}},
                               {"default, 1024 lights", {{"vpls", "1024"}}},
                               {"passes, 1024 lights", {{"vpls", "1024"}, {"gather", "device"}}},
                               {"full, 1024 lights", {{"vpls", "1024"}, {"mode", "full"}}},
                               asPaper("detail", {{"normal_threshold", "1.5"}, {"detail", "0.5"}})};
  for (const char* value : kThresholds)
    list.push_back(asPaper(std::string("threshold ") + value, {{"normal_threshold", value}}));
  for (const int side : {16, 24, 32, 40}) {
    for (const char* size : {"16", "64", "256", "1024"})
      list.push_back(asPaper(fmt::format("{0} x {0} lights at {1}", side, size),
                             {{"vpls", std::to_string(side * side)}, {"resolution", size}}));
  }
  return list;
}

/// Error over time, both against full resolution, along the sweep of thresholds and by default.
Plot plotOf(const Rounds& rounds) {
  std::vector<std::pair<double, double>> points;
  for (const char* value : kThresholds) {
    const std::string name = std::string("threshold ") + value;
    points.emplace_back(100.0 * rounds.ratio(name, "full"), rounds.error(name, "full"));
  }
  points.emplace_back(100.0 * rounds.ratio("default", "full"), rounds.error("default", "full"));
  std::sort(points.begin(), points.end());
  Plot plot{.title = "Error over time, full resolution being 100 % and without error",
            .across = "time, %",
            .up = "relative RMSE, %",
            .places = {},
            .curves = {{"normal threshold 1.5 to 0.05 as the paper has it; the defaults", {}}},
            .notes = {"gloam bench splatting --paper -o FILE.svg"}};
  for (const auto& [time, error] : points) {
    plot.places.push_back(time);
    plot.curves[0].values.push_back(error);
  }
  return plot;
}

void addSweeps(PaperTable& table, const BenchChoice& choice, Console& console) {
  const Rounds rounds = measureScene(choice, choice.scene.name, sweeps(), table, console);
  const auto add = [&](const std::string& name, double ours, std::optional<double> paper, const char* unit) {
    table.rows.push_back({choice.scene.name + ": " + name, ours, paper, unit, Better::kNone});
  };
  for (const char* lights : {"", ", 1024 lights"}) {
    const std::string ours = std::string("default") + lights, full = std::string("full") + lights,
                      passes = std::string("passes") + lights;
    add("defaults, faster than full resolution" + std::string(lights), rounds.ratio(full, ours), std::nullopt,
        "ratio");
    add("by compute passes, faster than full resolution" + std::string(lights), rounds.ratio(full, passes),
        std::nullopt, "ratio");
    add("defaults, relative RMSE against it" + std::string(lights), rounds.error(ours, full), std::nullopt,
        "%");
  }
  // Rates at 0.2 and 1.5 in three scenes: 7 9 8, 22 25 24.
  for (const char* value : kThresholds) {
    const std::string name = std::string("threshold ") + value;
    const bool printed = std::string(value) == "0.2";
    add("time at normal " + name + " over that at 1.5", rounds.ratio(name, "threshold 1.5"),
        printed ? std::optional(2.97) : std::nullopt, "ratio");
    add("relative RMSE at normal " + name, rounds.error(name, "full"), std::nullopt, "%");
  }
  add("time with detail put back over that without", rounds.ratio("detail", "threshold 1.5"), 1.0, "ratio");
  for (std::size_t i = 0; i < rounds.variants.size(); ++i) {
    const std::string& name = rounds.variants[i].name;
    if (name.find(" lights at ") != std::string::npos)
      add("time with " + name + " over 16 x 16 at 1024", rounds.ratio(name, "16 x 16 lights at 1024"),
          std::nullopt, "ratio");
  }
  table.plot = plotOf(rounds);
}

}  // namespace

PaperTable measureSplattingPaper(const BenchChoice& choice, Console& console) {
  PaperTable table;
  addSweeps(table, choice, console);
  addTable1(table, choice, console);
  addTriangles(table, choice, console);
  table.notes = {fmt::format("{}x{}, {} rounds; a ratio is the median over rounds of times of the passes "
                             "after reflective shadow maps and "
                             "G-buffer.",
                             choice.view.size.x, choice.view.size.y, choice.frames),
                 "The paper's rates are of whole frames on a GeForce GTX 280, in scenes that ours are like. "
                 "All but defaults and full "
                 "resolution are the paper's ways: without the light's own threshold, without merged lights, "
                 "with its upsampling."};
  return table;
}

}  // namespace gloam::cli
