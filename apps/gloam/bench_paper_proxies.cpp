// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Govindaraju, Nowrouzezahrai, Snyder 2007, "Image-based proxy accumulation for real-time soft global illumination",
// figures 4 to 9. Speeds are frame rates there (GeForce 8800GTX); here ratios of times, both sides in turn in one run.
#include <fmt/core.h>
#include <gloam/metrics.h>
#include <renderer/proxy_set.h>
#include <scene/environment.h>
#include <techniques/proxies/proxies_coverage.h>
#include <techniques/proxies/proxies_operators.h>
#include <techniques/proxies/proxies_tables.h>
#include <techniques/proxies/proxies_vertices.h>

#include <cmath>

#include "bench_paper.h"

namespace gloam::cli {
namespace {

using Better = PaperRow::Better;

constexpr int kCurvePoints = 100;
// Figure 5's picture is not described: a ball in the air over a ground four times as broad, in radii.
constexpr float kBallHeight = 3.0f, kGroundWidth = 8.0f;
constexpr const char* kPaperSpheres = "40";  // where nothing else is asked for

struct Variant {
  const char* name;
  std::vector<std::pair<const char*, const char*>> settings;
  bool vertices = false;
};
enum { kDisplay, kBilateral16, kBilateral64, kBilinear16, kBilinear64, kNoIndirect, kVertices, kVariants };
const std::vector<Variant>& variants() {
  static const std::vector<Variant> list = {
      {"display resolution", {{"divisor", "1"}}},
      {"bilateral 16x", {{"divisor", "4"}}},
      {"bilateral 64x", {{"divisor", "8"}}},
      {"bilinear 16x", {{"divisor", "4"}, {"upsample", "bilinear"}}},
      {"bilinear 64x", {{"divisor", "8"}, {"upsample", "bilinear"}}},
      {"bilateral 16x without indirect light", {{"divisor", "4"}, {"indirect", "off"}}},
      {"vertices", {}, true},
  };
  return list;
}

/// Milliseconds of a frame: all of its passes, and those that find its light.
struct FrameTime {
  double all = 0.0, light = 0.0, receivers_light = 0.0;
};
FrameTime timeOf(const std::vector<PassTime>& passes) {
  FrameTime time;
  for (const PassTime& pass : passes) {
    time.all += pass.milliseconds;
    const bool own = pass.name.starts_with("proxies.");
    if (own || pass.name.starts_with("frame.receivers") || pass.name == "frame.upsample")
      time.light += pass.milliseconds;
    if (own && pass.name != "proxies.upsample" && pass.name != "proxies.extend" &&
        pass.name != "proxies.misfits" && !pass.name.starts_with("proxies.repair"))
      time.receivers_light += pass.milliseconds;
  }
  return time;
}

struct Rounds {
  std::vector<FrameTime> times[kVariants];
  Image light[kVariants];  ///< linear radiance of the first round
  std::size_t vertices = 0;

  template <class Of>
  double ratio(int over, int under, const Of& of) const {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < times[over].size(); ++i)
      ratios.push_back(of(times[over][i]) / std::max(1e-9, of(times[under][i])));
    return quantile(ratios, 0.5);
  }
  double milliseconds(int variant) const {
    std::vector<double> all;
    for (const FrameTime& time : times[variant]) all.push_back(time.all);
    return quantile(all, 0.5);
  }
};

Rounds measureRounds(BenchStage& stage, const BenchChoice& choice, Console& console) {
  const ProxySet set(stage.scene, stage.spheres);
  proxies::VertexShading vertices(choice.device, stage.scene, stage.posed, stage.environment,
                                  set.posed(stage.posed));
  Rounds rounds;
  rounds.vertices = vertices.vertexCount();
  const Progress progress = console.progress();
  const int all = choice.frames + 1;
  for (int round = -1; round < choice.frames; ++round) {  // one to warm up
    for (int v = 0; v < kVariants; ++v) {
      if (interrupted()) throw Interrupted("interrupted: no figures");
      const Variant& variant = variants()[std::size_t(v)];
      progress.report((double(round + 1) + double(v) / double(kVariants)) / double(all), variant.name);
      RenderOptions options = stage.options;
      for (const auto& [name, value] : variant.settings) options.settings.set(name, value);
      if (variant.vertices) {
        const std::vector<PassTime> passes = vertices.shade(options.settings);
        if (round >= 0) rounds.times[v].push_back(timeOf(passes));
        continue;
      }
      const RenderedFrame frame = stage.renderer.render(stage.posed, stage.camera, options);
      if (round >= 0) rounds.times[v].push_back(timeOf(frame.passes));
      if (round < 0) rounds.light[v] = frame.layers.image("", {"R", "G", "B"}, "frame");
    }
  }
  console.endProgress();
  checkValidation(stage.renderer);
  return rounds;
}

void addOperators(PaperTable& table, const sh::ShRgb& scene_light) {
  const sh::ShRgb low_sun =
      sh::colored(sh::directionalLight(proxies::kShadowOrder, {1, 0, 0}), glm::vec3(1.0f));
  const std::pair<const char*, const sh::ShRgb*> lights[] = {{"this scene's light", &scene_light},
                                                             {"a sun on the horizon", &low_sun}};
  const char* names[2] = {"averaged", "point-sampled"};
  const double paper[2] = {0.28, 7.13};
  for (const auto& [light_name, light] : lights) {
    const proxies::PlaneErrors plane = proxies::planeErrors(*light, kBallHeight, kGroundWidth);
    const double errors[2] = {plane.averaged, plane.point};
    for (int i = 0; i < 2; ++i) {
      const std::string name = fmt::format("{} against exact, on a ground, {}", names[i], light_name);
      const Better better = i == 0 ? Better::kLower : Better::kNone;
      table.rows.push_back({name + ": relative squared error", 100.0 * errors[i], paper[i], "%", better});
      table.rows.push_back(
          {name + ": relative RMS", 100.0 * std::sqrt(errors[i]), paper[i], "%", Better::kNone});
    }
  }
  const proxies::FitErrors fits = proxies::fitErrors();
  table.rows.push_back({"quadratic fit of D1: relative squared error", 100.0 * fits.linear, 0.00016, "%",
                        Better::kLower, 2.0});
  table.rows.push_back(
      {"cubic fit of D2: relative squared error", 100.0 * fits.quadratic, 0.00064, "%", Better::kLower, 2.0});
  table.plot = {
      .title = "Indirect light of one proxy: operators against the exact one",
      .across = "sine of the half-angle",
      .up = "Frobenius distance, % of the exact one's norm",
      .curves = {{"averaged over the disc (PX-4, fitted)", {}}, {"sampled at one point (PX-3)", {}}},
      .notes = {"gloam bench proxies --paper -o FILE.svg"}};
  for (const proxies::OperatorDistance& d : proxies::operatorDistances(kCurvePoints)) {
    table.plot.places.push_back(double(d.sine));
    table.plot.curves[0].values.push_back(100.0 * d.averaged);
    table.plot.curves[1].values.push_back(100.0 * d.point);
  }
}

void addSpeeds(PaperTable& table, const Rounds& rounds) {
  const auto whole = [](const FrameTime& t) { return t.all; };
  const auto light = [](const FrameTime& t) { return t.light; };
  const auto receivers = [](const FrameTime& t) { return t.receivers_light; };
  const auto add = [&](const std::string& name, double ours, std::optional<double> paper, const char* unit,
                       Better better) {
    table.rows.push_back({name, ours, paper, unit, better});
  };
  const auto both = [&](const std::string& name, int over, int under, double paper, Better better) {
    add(name + ", whole frame", rounds.ratio(over, under, whole), paper, "ratio", better);
    add(name + ", light alone", rounds.ratio(over, under, light), paper, "ratio", better);
  };
  both("speed with 16x fewer receivers, bilateral, over display resolution", kDisplay, kBilateral16,
       66.0 / 8.0, Better::kHigher);
  both("speed with 64x fewer receivers, bilateral, over display resolution", kDisplay, kBilateral64,
       99.0 / 8.0, Better::kHigher);
  both("speed of bilinear over bilateral, 16x", kBilateral16, kBilinear16, 88.0 / 66.0, Better::kLower);
  both("speed of bilinear over bilateral, 64x", kBilateral64, kBilinear64, 171.0 / 99.0, Better::kLower);
  for (const int v : {kBilateral16, kBilateral64, kBilinear16, kBilinear64}) {
    add(fmt::format("{}: relative squared error against display resolution", variants()[std::size_t(v)].name),
        100.0 * relativeSquaredError(rounds.light[v], rounds.light[kDisplay]), std::nullopt, "%",
        Better::kLower);
  }
  both("time with indirect light over without, 16x", kBilateral16, kNoIndirect, 55.0 / 41.0, Better::kLower);
  add(fmt::format("time of {} vertices over {} receivers, one kernel", countText(rounds.vertices),
                  "16x fewer"),
      rounds.ratio(kVertices, kBilateral16, receivers), std::nullopt, "ratio", Better::kNone);
  add("time of vertices over image space with upsampling", rounds.ratio(kVertices, kBilateral16, light),
      63.0 / 30.0, "ratio", Better::kNone);
  constexpr int kShown[] = {kDisplay, kBilateral16, kBilinear16, kBilateral64, kBilinear64, kNoIndirect};
  constexpr double kPaperRates[] = {8.0, 66.0, 88.0, 99.0, 171.0, 55.0};
  for (std::size_t i = 0; i < std::size(kShown); ++i) {
    add(fmt::format("{}: rate", variants()[std::size_t(kShown[i])].name),
        1e3 / std::max(1e-6, rounds.milliseconds(kShown[i])), kPaperRates[i], "frames/s", Better::kNone);
  }
}

void addOrders(PaperTable& table) {
  const auto add = [&](const char* name, double ours, double paper, const char* unit) {
    table.rows.push_back({name, ours, paper, unit, Better::kNone});
  };
  add("order of log visibility", proxies::kShadowOrder, 4, "bands");
  add("order of indirect light", proxies::kIndirectOrder, 3, "bands");
  add("reach of a proxy's shadow", double(proxies::kFixedReach.shadow), 15, "radii");
  add("reach of a proxy's indirect light", double(proxies::kFixedReach.indirect), 10, "radii");
}

}  // namespace

PaperTable measureProxiesPaper(const BenchChoice& asked, Console& console) {
  BenchChoice choice = asked;
  choice.technique.values["proxies"].try_emplace("spheres", kPaperSpheres);
  BenchStage stage = prepareBench(choice, console);
  if (stage.environment.empty()) throw Error(choice.scene.name, "--paper needs light from afar (--env)");
  console.release();
  PaperTable table;
  table.device = stage.renderer.device().name;
  addOperators(table, projectEnvironment(stage.environment, proxies::kShadowOrder));
  addSpeeds(table, measureRounds(stage, choice, console));
  addOrders(table);
  table.notes = {
      fmt::format(
          "{} at {}x{}, {} spheres, {} rounds; a ratio is the median over rounds of times by the passes' own "
          "timers.",
          choice.scene.name, choice.view.size.x, choice.view.size.y, stage.spheres.count(), choice.frames),
      "\"light alone\" leaves out the G-buffer, lamps, and the steps from light to colour, which the paper's "
      "device did "
      "in no time. The paper's rates are of a GeForce 8800GTX.",
      "The paper does not say what its figure 5 shows, and calls its errors RMS there, relative squared in "
      "the text: here a "
      "ball of radius 1 at height 3 over a ground of 8 by 8, both measures. Only squared ones come near the "
      "paper's pair."};
  return table;
}

}  // namespace gloam::cli
