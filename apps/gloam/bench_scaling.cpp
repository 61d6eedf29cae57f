// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bench_scaling.h"

#include <fmt/core.h>
#include <scene/builtin_shapes.h>
#include <scene/scene_builder.h>

#include <array>

#include "emission_run.h"
#include "plot.h"
#include "verb.h"

namespace gloam::cli {
namespace {

constexpr std::array<int, 6> kCounts = {10, 50, 200, 500, 1000, 2000};
constexpr std::array<int, 6> kCountsBehindOthers = {5,  10, 20, 30,
                                                    60, 120};  // where spheres stand in each other's light
constexpr float kRadius = 0.12f, kGroundWidth = 20.0f;
constexpr int kTurns = 3;  // all numbers in turn, so that a machine that changes its speed changes all

struct Crowd {
  Scene scene;
  SceneSpheres spheres;
};

/// Places by an additive recurrence: the first n of any number are spread evenly.
Crowd crowdOf(int count) {
  SceneBuilder builder("crowd");
  builder.place("ground", shapes::ground(kGroundWidth, kGroundWidth, 4, 4),
                builder.diffuse("ground", glm::vec3(0.5f)));
  const int ball =
      builder.mesh("ball", shapes::icosphere(kRadius, 4), builder.diffuse("ball", {0.7f, 0.4f, 0.3f}));
  SphereSet set{.name = "ball", .meshes = {ball}, .spheres = {{glm::vec3(0.0f), kRadius}}};
  for (int i = 0; i < count; ++i) {
    const double x = std::fmod(0.7548776662466927 * (i + 1), 1.0),
                 z = std::fmod(0.5698402909980532 * (i + 1), 1.0);
    const float across = 0.95f * kGroundWidth;
    const int node =
        builder.node("ball", kNone, {across * (float(x) - 0.5f), kRadius, across * (float(z) - 0.5f)});
    builder.at(node).meshes = {ball};
    set.nodes.push_back(node);
  }
  builder.camera({0.0f, 9.0f, 13.0f}, {0.0f, 0.0f, 0.5f}, 52.0f);
  builder.sky("mild");
  return {builder.finish(), {.sets = {set}}};
}

/// Microseconds of light that each sphere more costs, from the point before.
double microsecondsMore(const std::vector<ScalingPoint>& points, std::size_t i) {
  return 1e3 * (points[i].light_ms - points[i - 1].light_ms) / double(points[i].count - points[i - 1].count);
}

Plot plotOf(const std::vector<ScalingPoint>& points, const std::string& device, const std::string& size) {
  Plot plot{.title = "Time of a frame over the number of proxies",
            .across = "proxies",
            .up = "milliseconds",
            .curves = {{"whole frame", {}}, {"light alone", {}}},
            .notes = {fmt::format("{}, {}", device, size)}};
  for (const ScalingPoint& point : points) {
    plot.places.push_back(point.count);
    plot.curves[0].values.push_back(point.frame_ms);
    plot.curves[1].values.push_back(point.light_ms);
  }
  return plot;
}

void print(const std::vector<ScalingPoint>& points, const std::string& device, const std::string& size,
           int frames, Console& console) {
  if (console.json) {
    Json json = Json::array();
    for (const ScalingPoint& point : points)
      json.push_back({{"proxies", point.count},
                      {"frame_ms", point.frame_ms},
                      {"light_ms", point.light_ms},
                      {"passes", point.timings.passesJson()}});
    console.print(jsonText({{"device", device}, {"size", size}, {"frames", frames}, {"points", json}}));
    return;
  }
  console.print(
      fmt::format("{}, {}: balls of one size over one ground, a sphere each; medians", device, size));
  console.print(fmt::format("{:>8}  {:>10}  {:>10}  {:>24}", "proxies", "frame ms", "light ms",
                            "microseconds each more"));
  for (std::size_t i = 0; i < points.size(); ++i) {
    console.print(fmt::format("{:>8}  {:>10.2f}  {:>10.2f}  {:>24}", points[i].count, points[i].frame_ms,
                              points[i].light_ms,
                              i == 0 ? std::string() : fmt::format("{:.1f}", microsecondsMore(points, i))));
  }
}

}  // namespace

std::vector<ScalingPoint> measureScaling(Renderer& renderer, const RenderOptions& options, int frames,
                                         Console& console) {
  std::vector<ScalingPoint> points;
  for (const int count : technique(options.technique).needs_emission ? kCountsBehindOthers : kCounts)
    points.push_back({.count = count});
  const Progress progress = console.progress();
  const int each = std::max(1, (frames + kTurns - 1) / kTurns);
  double done = 0.0;
  for (int turn = 0; turn < kTurns; ++turn) {
    for (ScalingPoint& point : points) {
      const Crowd crowd = crowdOf(point.count);
      renderer.setScene(crowd.scene);
      giveSpheres(renderer, technique(options.technique), crowd.scene, crowd.spheres, "crowd", false,
                  console);
      const PosedScene posed = pose(crowd.scene, 0.0f);
      for (int i = -1; i < each; ++i) {
        if (interrupted()) throw Interrupted("interrupted: no figures");
        progress.report(done++ / double(kTurns * int(points.size()) * (each + 1)),
                        fmt::format("{} spheres", point.count));
        const RenderedFrame frame = renderer.render(posed, posed.cameras.at(0), options);
        double all = 0.0;
        for (const PassTime& pass : frame.passes) all += pass.milliseconds;
        if (i >= 0) point.timings.add(frame, all);
      }
    }
  }
  console.endProgress();
  for (ScalingPoint& point : points) {
    point.frame_ms = point.timings.medianPassesMs();
    point.light_ms = point.timings.medianMs(options.technique + ".");
  }
  return points;
}

int benchScaling(const BenchChoice& choice, Console& console) {
  const TechniqueInfo& info = technique(choice.subject);
  if (!info.needs_spheres) throw Error("--scaling", fmt::format("{} takes no spheres", info.name));
  if (!choice.output.empty()) checkPlotPath(choice.output);
  Renderer renderer(choice.device);
  RenderOptions options;
  options.width = choice.view.size.x, options.height = choice.view.size.y;
  options.technique = info.name;
  options.settings = settingsFor(info, choice.technique);
  options.timings = true;
  options.layers = options.parts = false;
  console.release();
  const std::vector<ScalingPoint> points = measureScaling(renderer, options, choice.frames, console);
  checkValidation(renderer);
  const std::string size = fmt::format("{}x{}", options.width, options.height);
  if (!choice.output.empty()) writePlot(plotOf(points, renderer.device().name, size), choice.output);
  print(points, renderer.device().name, size, choice.frames, console);
  return kDone;
}

}  // namespace gloam::cli
