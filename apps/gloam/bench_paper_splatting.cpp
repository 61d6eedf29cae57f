// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Nichols, Wyman 2009, "Multiresolution splatting for indirect illumination": table 1, figures 7 to 9. Rates there (GeForce
// GTX 280, another scene each); here ratios of times in one scene, all variants in turn in one run.
#include <fmt/core.h>
#include <gloam/metrics.h>

#include <algorithm>
#include <cmath>

#include "bench_paper.h"

namespace gloam::cli {
namespace {

using Better = PaperRow::Better;

struct Variant {
  const char* name;
  std::vector<std::pair<const char*, const char*>> settings;
};
enum { kOurs, kFull, k128, k256, k512, k1024, kFine, kCoarse, kDetail, kFewLights, kManyLights, kVariants };

/// The paper's own ways: no word of the light's change, its upsampling, a grid of 16 by 16 lights.
Variant asPaper(const char* name, std::vector<std::pair<const char*, const char*>> settings) {
  settings.insert(
      settings.begin(),
      {{"light_threshold", "0"}, {"upsample", "paper"}, {"vpls", "256"}, {"normal_threshold", "0.5"}});
  return {name, settings};
}

const std::vector<Variant>& variants() {
  static const std::vector<Variant> list = {
      {"as it is by default", {}},
      {"full resolution", {{"mode", "full"}}},
      asPaper("128", {{"resolution", "128"}}),
      asPaper("256", {{"resolution", "256"}}),
      asPaper("512", {{"resolution", "512"}}),
      asPaper("1024", {{"resolution", "1024"}}),
      asPaper("normal threshold 0.2", {{"normal_threshold", "0.2"}}),
      asPaper("normal threshold 1.5", {{"normal_threshold", "1.5"}}),
      asPaper("normal threshold 1.5 with detail", {{"normal_threshold", "1.5"}, {"detail", "0.5"}}),
      asPaper("1024, 16 x 16 lights", {}),
      asPaper("1024, 32 x 32 lights", {{"vpls", "1024"}}),
  };
  return list;
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

struct Rounds {
  std::vector<double> own[kVariants];
  Image light[kVariants];

  /// Median over rounds of one variant's time over another's.
  double ratio(int over, int under) const {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < own[over].size(); ++i)
      ratios.push_back(own[over][i] / std::max(1e-9, own[under][i]));
    return quantile(ratios, 0.5);
  }
  double error(int variant) const {
    return std::sqrt(relativeSquaredError(light[variant], light[kFull])) * 100.0;
  }
};

Rounds measureRounds(BenchStage& stage, const BenchChoice& choice, Console& console) {
  Rounds rounds;
  const Progress progress = console.progress();
  for (int round = -1; round < choice.frames; ++round) {  // one to warm up
    for (int v = 0; v < kVariants; ++v) {
      if (interrupted()) throw Interrupted("interrupted: no figures");
      const Variant& variant = variants()[std::size_t(v)];
      progress.report((double(round + 1) + double(v) / double(kVariants)) / double(choice.frames + 1),
                      variant.name);
      RenderOptions options = stage.options;
      for (const auto& [name, value] : variant.settings) options.settings.set(name, value);
      const RenderedFrame frame = stage.renderer.render(stage.posed, stage.camera, options);
      if (round >= 0) rounds.own[v].push_back(ownTime(frame.passes));
      if (round < 0) rounds.light[v] = frame.layers.image("indirect", {"R", "G", "B"}, "frame");
    }
  }
  console.endProgress();
  return rounds;
}

/// Error over time, both against full resolution, along the sweep of thresholds and by default.
Plot plotOf(const Rounds& rounds) {
  std::vector<std::pair<double, double>> points;
  for (const int v : {int(kCoarse), int(k1024), int(kFine), int(kOurs)})
    points.emplace_back(100.0 * rounds.ratio(v, kFull), rounds.error(v));
  std::sort(points.begin(), points.end());
  Plot plot{.title = "Error over time, full resolution being 100 % and without error",
            .across = "time, %",
            .up = "relative RMSE, %",
            .places = {},
            .curves = {{"normal threshold 1.5, 0.5, 0.2 as the paper has it; the defaults", {}}},
            .notes = {"gloam bench splatting --paper -o FILE.svg"}};
  for (const auto& [time, error] : points) {
    plot.places.push_back(time);
    plot.curves[0].values.push_back(error);
  }
  return plot;
}

}  // namespace

PaperTable measureSplattingPaper(const BenchChoice& choice, Console& console) {
  BenchStage stage = prepareBench(choice, console);
  if (stage.posed.lights.empty())
    throw Error(choice.scene.name, "--paper needs lamps, such as those of builtin:swing");
  console.release();
  const Rounds rounds = measureRounds(stage, choice, console);
  PaperTable table;
  table.device = stage.renderer.device().name;
  const auto add = [&](const std::string& name, double ours, std::optional<double> paper, const char* unit) {
    table.rows.push_back({name, ours, paper, unit, Better::kNone});
  };
  // Rates of its four scenes at 128 to 1024: 68 50 33 22, 60 42 30 24, 59 42 28 21, 52 41 31 25; their mean ratios.
  add("time at 128 over that at 1024", rounds.ratio(k128, k1024), 0.39, "ratio");
  add("time at 256 over that at 1024", rounds.ratio(k256, k1024), 0.53, "ratio");
  add("time at 512 over that at 1024", rounds.ratio(k512, k1024), 0.76, "ratio");
  add("time at normal threshold 0.2 over that at 1.5", rounds.ratio(kFine, kCoarse), 2.97, "ratio");
  add("time with detail put back over that without", rounds.ratio(kDetail, kCoarse), 1.0, "ratio");
  add("time with 32 x 32 lights over that with 16 x 16", rounds.ratio(kManyLights, kFewLights), std::nullopt,
      "ratio");
  table.rows.push_back({"faster than full resolution", rounds.ratio(kFull, kOurs), std::nullopt, "ratio"});
  for (const int v : {int(kOurs), int(k128), int(k256), int(k512), int(k1024), int(kFine), int(kCoarse)})
    add(fmt::format("relative RMSE against full resolution, {}", variants()[std::size_t(v)].name),
        rounds.error(v), std::nullopt, "%");
  table.plot = plotOf(rounds);
  table.notes = {
      fmt::format("{} at {}x{}, {} rounds; a ratio is the median over rounds of times of the passes after "
                  "reflective shadow maps "
                  "and G-buffer.",
                  choice.scene.name, choice.view.size.x, choice.view.size.y, choice.frames),
      "The paper's rates are of whole frames on a GeForce GTX 280, in scenes of its own, shown at 1024 x "
      "1024. All but the first "
      "two variants are the paper's ways: without the light's own threshold, with its upsampling."};
  return table;
}

}  // namespace gloam::cli
