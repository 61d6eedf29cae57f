// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The rays of interleaved sampling: pixels in sets of 8 x 8, each towards all virtual lights of its set. Both sides are measured in turn,
// by processor time, so that a machine that changes its speed changes both.
#include "bench_visibility.h"

#include <fmt/core.h>
#include <frame/frame.h>
#include <scene/camera_rays.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <visibility/host_sight.h>
#include <visibility/host_world.h>
#include <vpls/walks.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "json.h"
#include "verb.h"

namespace gloam::cli {
namespace {

constexpr int kPattern = 8, kRounds = 9;
constexpr std::size_t kChunk = 4096;
constexpr vpls::WalkOptions kWalks{.sets = kPattern * kPattern, .direct = 16, .indirect = 32, .bounces = 2};

double processorSeconds() {
  return double(std::clock()) / double(CLOCKS_PER_SEC);
}
double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// What the camera sees, set by set: pixels of one set follow one another.
std::vector<visibility::SightPoint> pointsSeen(const visibility::WorldTracer& tracer,
                                               const PosedCamera& camera, glm::ivec2 size) {
  const CameraRays rays = makeCameraRays(camera, size.x, size.y);
  std::vector<visibility::SightPoint> points;
  for (int set = 0; set < kPattern * kPattern; ++set) {
    for (int y = set / kPattern; y < size.y; y += kPattern) {
      for (int x = set % kPattern; x < size.x; x += kPattern) {
        const glm::vec3 origin = rays.origin(float(x) + 0.5f, float(y) + 0.5f);
        const glm::vec3 way = glm::normalize(rays.direction(float(x) + 0.5f, float(y) + 0.5f));
        visibility::SightPoint& point = points.emplace_back();
        point.set = std::uint32_t(set);
        const trace::Hit hit = tracer.closest({origin, way});
        if (!hit) continue;
        point.position = origin + hit.distance * way;
        point.normal =
            glm::dot(hit.geometric_normal, way) > 0.0f ? -hit.geometric_normal : hit.geometric_normal;
        point.offset = 1e-4f * hit.distance;
      }
    }
  }
  return points;
}

/// A scene on the device, and its virtual lights.
struct Stage {
  explicit Stage(const std::string& name)
      : device(gpu::Device::create({.choice = name})), graph(*device), environment(*device), sight(*device) {}

  void prepare(const Scene& scene, const Environment& light, const PosedScene& posed,
               const PosedCamera& camera, glm::ivec2 size) {
    gpu_scene.emplace(*device, scene);
    environment.set(light);
    vpls::Walks walks;
    draw(posed, camera, [&](gpu::FrameGraph& g, const frame::FrameInputs& inputs) {
      walks = walker.record(g, inputs, kWalks, sight.world());
      return frame::Lighting{};
    });
    words = walks.words();
    if (walks.set_count > 0) {
      rows = walks.rows.buffer().download<vpls::WalkVpl>();
      sets = walks.sets.buffer().download<visibility::SightSet>();
    }
    points = pointsSeen(sight.world().tracer(), camera, size);
  }

  void draw(const PosedScene& posed, const PosedCamera& camera, const frame::LightingStep& step) {
    graph.begin();
    frame::recordFrame(graph, *gpu_scene, environment, posed, camera,
                       {.width = 16, .height = 16, .layers = false}, step, memory, warnings);
    graph.execute();
    graph.wait();
  }

  /// Milliseconds of a frame's walks; where things moved, of another hierarchy, too.
  double walk(const PosedScene& posed, const PosedCamera& camera) {
    graph.setTimed(true);
    draw(posed, camera, [&](gpu::FrameGraph& g, const frame::FrameInputs& inputs) {
      walker.record(g, inputs, kWalks, sight.world());
      return frame::Lighting{};
    });
    return millisecondsOf("vpls.walks");
  }

  double millisecondsOf(const std::string& name) {
    double milliseconds = 0.0;
    for (const gpu::PassTime& pass : graph.times())
      milliseconds += pass.name == name ? pass.milliseconds : 0.0;
    return milliseconds;
  }

  /// Milliseconds of the pass, by a means.
  double ask(const PosedScene& posed, const PosedCamera& camera, visibility::Means means,
             std::vector<std::uint32_t>& bits) {
    gpu::BufferRef visible;
    graph.setTimed(true);
    draw(posed, camera, [&](gpu::FrameGraph& g, const frame::FrameInputs& inputs) {
      const visibility::Question question{.points = g.upload("bench.points", points),
                                          .point_count = std::uint32_t(points.size()),
                                          .lights = g.upload("bench.lights", rows),
                                          .light_bytes = sizeof(vpls::WalkVpl),
                                          .sets = g.upload("bench.sets", sets),
                                          .set_count = std::uint32_t(sets.size()),
                                          .words = words};
      visible = sight.record(g, "bench.visibility", inputs.scene, question, means);
      return frame::Lighting{};
    });
    bits = visible.buffer().download<std::uint32_t>();
    return millisecondsOf("bench.visibility");
  }

  std::unique_ptr<gpu::Device> device;
  gpu::FrameGraph graph;
  std::optional<frame::GpuScene> gpu_scene;
  frame::EnvironmentLight environment;
  visibility::Visibility sight;
  vpls::Walker walker;
  frame::FrameMemory memory;
  Warnings warnings;
  std::vector<vpls::WalkVpl> rows;
  std::vector<visibility::SightSet> sets;
  std::vector<visibility::SightPoint> points;
  std::uint32_t words = 0;
};

struct Measured {
  std::size_t triangles = 0, points = 0, rays = 0, open = 0;
  double bare_mrays_s = 0.0, host_mrays_s = 0.0, ratio = 0.0, device_mrays_s = 0.0, differing = 0.0;
  double still_ms = 0.0, moved_ms = 0.0;
};

void measureHost(const Stage& stage, const visibility::WorldTracer& tracer, Measured& result) {
  const visibility::LightRows rows{reinterpret_cast<const std::byte*>(stage.rows.data()),
                                   sizeof(vpls::WalkVpl), stage.rows.size()};
  const std::vector<trace::LoggedRay> rays =
      visibility::sightRays(stage.points, rows, stage.sets, stage.words);
  std::vector<std::uint32_t> bits(stage.points.size() * stage.words);
  result.rays = rays.size();
  if (rays.empty()) return;
  std::vector<double> bare, host, ratios;
  for (int round = -1; round < kRounds; ++round) {
    if (interrupted()) throw Interrupted("interrupted: no figures");
    const double start = processorSeconds();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size(), kChunk), [&](const auto& range) {
      tracer.replay(std::span(rays).subspan(range.begin(), range.size()));
    });
    const double middle = processorSeconds();
    visibility::traceSight(tracer, stage.points, rows, stage.sets, stage.words, bits);
    const double end = processorSeconds();
    if (round < 0) continue;
    bare.push_back(double(rays.size()) / (middle - start) / 1e6);
    host.push_back(double(rays.size()) / (end - middle) / 1e6);
    ratios.push_back((middle - start) / (end - middle));
  }
  result.bare_mrays_s = median(bare);
  result.host_mrays_s = median(host);
  result.ratio = median(ratios);
}

void measureDevice(Stage& stage, const PosedScene& posed, const PosedCamera& camera, Measured& result) {
  if (result.rays == 0) return;
  std::vector<std::uint32_t> host, device;
  stage.ask(posed, camera, visibility::Means::kHost, host);
  stage.ask(posed, camera, visibility::Means::kDevice, device);  // shaders are compiled, boxes built
  const double milliseconds = stage.ask(posed, camera, visibility::Means::kDevice, device);
  result.device_mrays_s = double(result.rays) / milliseconds / 1e3;
  std::size_t differing = 0;
  for (std::size_t i = 0; i < host.size(); ++i) {
    differing += std::size_t(__builtin_popcount(host[i] ^ device[i]));
    result.open += std::size_t(__builtin_popcount(host[i]));
  }
  result.differing = double(differing) / double(result.rays);
}

void measureWalks(Stage& stage, const PosedScene& posed, const PosedCamera& camera, Measured& result) {
  PosedScene moved = posed;
  std::vector<double> still_ms, moved_ms;
  for (int round = 0; round < kRounds; ++round) {
    if (!moved.instances.empty()) moved.instances[0].world_from_object[3].y += 1e-5f;
    moved_ms.push_back(stage.walk(moved, camera));
    still_ms.push_back(stage.walk(moved, camera));
  }
  result.still_ms = median(still_ms);
  result.moved_ms = median(moved_ms);
}

}  // namespace

int benchVisibility(const BenchChoice& choice, Console& console) {
  const Scene scene = loadSceneToDraw(choice.scene, console);
  const Environment environment = chooseEnvironment(scene, choice.light, console, choice.view.time_s);
  const PosedScene posed = pose(scene, choice.view.time_s);
  const PosedCamera camera = chooseCamera(posed, choice.view, console);
  console.release();
  Stage stage(choice.device);
  stage.prepare(scene, environment, posed, camera, choice.view.size * choice.view.supersample);
  const visibility::WorldTracer& tracer = stage.sight.world().tracer();
  Measured m{.triangles = tracer.triangleCount(), .points = stage.points.size()};
  measureHost(stage, tracer, m);
  measureDevice(stage, posed, camera, m);
  measureWalks(stage, posed, camera, m);
  if (m.rays == 0)
    throw Error("bench visibility",
                "no light faces what the camera sees; another scene, light or camera is needed");
  const double open = double(m.open) / double(m.rays);
  if (!console.json) {
    console.print(fmt::format(
        "{}, {}x{}: {} triangles, {} pixels, {} sets of {}x{}, {:.3g} rays, {:.0f} % open, {} rounds",
        choice.scene.name, choice.view.size.x, choice.view.size.y, countText(m.triangles),
        countText(m.points), kWalks.sets, kPattern, kPattern, double(m.rays), 100.0 * open, kRounds));
    console.print(
        fmt::format("Embree alone    {:8.2f} Mrays/s a core, one ray after the other", m.bare_mrays_s));
    console.print(fmt::format("host            {:8.2f} Mrays/s a core, from points and lights to bits",
                              m.host_mrays_s));
    console.print(fmt::format("ratio           {:8.3f}", m.ratio));
    console.print(fmt::format("device          {:8.2f} Mrays/s in all, {}", m.device_mrays_s,
                              stage.device->info().name));
    console.print(fmt::format("other bits      {:8.5f} % of rays", 100.0 * m.differing));
    console.print(
        fmt::format("walks           {:8.2f} ms a frame, {:.2f} where something moved: another hierarchy",
                    m.still_ms, m.moved_ms));
    return kDone;
  }
  console.print(jsonText({{"device", stage.device->info().name},
                          {"scene", choice.scene.name},
                          {"size", fmt::format("{}x{}", choice.view.size.x, choice.view.size.y)},
                          {"triangles", m.triangles},
                          {"points", m.points},
                          {"sets", kWalks.sets},
                          {"rays", m.rays},
                          {"open", open},
                          {"rounds", kRounds},
                          {"bare_mrays_s", m.bare_mrays_s},
                          {"host_mrays_s", m.host_mrays_s},
                          {"ratio", m.ratio},
                          {"device_mrays_s", m.device_mrays_s},
                          {"differing", m.differing},
                          {"walks_ms", m.still_ms},
                          {"walks_moved_ms", m.moved_ms}}));
  return kDone;
}

}  // namespace gloam::cli
