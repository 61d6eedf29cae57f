// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Relighting against its two bounds: the light's coefficients in microseconds whatever the lights are, and the transfer's bytes
// once through memory. Copies and frames are measured in turn, and the best of each counts: other programs only ever add time.
#include "bench_relight.h"

#include <fmt/core.h>
#include <gloam/lights.h>
#include <gloam/renderer.h>
#include <gpu/buffer.h>
#include <gpu/frame_graph.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "json.h"
#include "technique_choice.h"
#include "timings.h"
#include "verb.h"

namespace gloam::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kRounds = 15, kWarmUpRounds = 2;
constexpr std::size_t kCopiedBytes = std::size_t(64) << 20;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// A wavy sheet of about that many vertices whose transfer is made up: time does not depend on its values.
Scene sheet(int vertices) {
  const int side = int(std::ceil(std::sqrt(double(vertices))));
  Scene scene;
  scene.materials.emplace_back();
  Mesh mesh;
  auto transfer = std::make_shared<Transfer>();
  transfer->order = 5;
  transfer->bounces = 1;
  transfer->directions = 1;
  for (int i = 0; i < side * side; ++i) {
    const float x = float(i % side) / float(side - 1) - 0.5f, z = float(i / side) / float(side - 1) - 0.5f;
    mesh.positions.emplace_back(x, 0.05f * std::sin(20.0f * x) * std::cos(17.0f * z), z);
  }
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0, 1, 0));
  for (int z = 0; z + 1 < side; ++z) {
    for (int x = 0; x + 1 < side; ++x) {
      const auto i = std::uint32_t(z * side + x), below = i + std::uint32_t(side);
      mesh.indices.insert(mesh.indices.end(), {i, below, below + 1, i, below + 1, i + 1});
    }
  }
  const sh::Sh cosine = sh::rotateZonal(sh::clampedCosine(5), {0, 1, 0});
  transfer->direct.reserve(mesh.positions.size() * 25);
  transfer->indirect.reserve(mesh.positions.size() * 75);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    for (int i = 0; i < 25; ++i) {
      transfer->direct.push_back(cosine[i]);
      for (int c = 0; c < 3; ++c) transfer->indirect.push_back(0.1f * cosine[i]);
    }
  }
  mesh.transfer = std::move(transfer);
  scene.meshes.push_back(std::move(mesh));
  scene.nodes.emplace_back().meshes = {0};
  scene.roots = {0};
  return scene;
}

/// Bytes of transfer that a relighting reads: of every instance, each number once.
double transferBytes(const Scene& scene, const PosedScene& posed, bool half_float) {
  double numbers = 0.0;
  for (const Instance& instance : posed.instances) {
    const Transfer* transfer = scene.meshes[std::size_t(instance.mesh)].transfer.get();
    if (transfer != nullptr) numbers += double(transfer->direct.size() + transfer->indirect.size());
  }
  return numbers * (half_float ? 2.0 : 4.0);
}

/// Copies within the device's memory.
class Copies {
 public:
  Copies() : device_(gpu::Device::create()), graph_(*device_) {
    const std::vector<std::uint32_t> words(kCopiedBytes / 4, 1u);
    from_ = gpu::Buffer(*device_, "bench.from", words);
    to_ = gpu::Buffer(*device_, "bench.to", gpu::BufferDesc{.bytes = kCopiedBytes});
    graph_.setTimed(true);
  }
  double milliseconds() {
    graph_.begin();
    graph_.copy("bench.copy", graph_.import("bench.from", from_), graph_.import("bench.to", to_));
    graph_.execute();
    graph_.wait();
    return graph_.times().at(0).milliseconds;
  }
  std::string device() const { return device_->info().name; }

 private:
  std::unique_ptr<gpu::Device> device_;
  gpu::FrameGraph graph_;
  gpu::Buffer from_, to_;
};

std::vector<std::string> discs(int count) {
  std::vector<std::string> texts;
  for (int i = 0; i < count; ++i)
    texts.push_back(fmt::format("disc?azimuth=0:{},100:{}&elevation={}&radius={}&irradiance={}", i * 5.6,
                                i * 5.6 + 3600, 5 + (i * 7) % 80, 0.3 + i % 12, 3.0 / count));
  return texts;
}

/// Microseconds from the lights' keys to order-6 coefficients.
double lightMicroseconds(const AnimatedLights& lights) {
  std::vector<double> samples;
  float sum = 0.0f;
  for (int round = 0; round < 200; ++round) {
    const auto start = Clock::now();
    sum += projectLights(lights.at(0.1f * float(round)), sh::kMaxOrder)[0].r;
    samples.push_back(1000.0 * millisecondsSince(start));
  }
  return std::isfinite(sum) ? quantile(samples, 0.0) : 0.0;
}

class Subject {
 public:
  Subject(std::string name, Scene scene)
      : name_(std::move(name)), scene_(std::move(scene)), posed_(pose(scene_, 0.0f)) {
    renderer_.setScene(scene_);
    options_.width = options_.height = 16;
    options_.technique = "prt";
    options_.timings = true;
    options_.layers = options_.parts = false;
    camera_ = framingCamera(posed_, 1.0f);
    // A camera that sees nothing: all vertices are lit, no pixel is.
    camera_.world_from_view[3] += glm::vec4(0.0f, 1e4f, 0.0f, 0.0f);
    light(AnimatedLights::parse(discs(1)), 0.0f);
  }
  /// Microseconds from the lights' keys to a renderer that is ready to draw with them.
  double light(const AnimatedLights& lights, float time_s) {
    const auto start = Clock::now();
    renderer_.setEnvironment(describeLights(lights.at(time_s)));
    return 1000.0 * millisecondsSince(start);
  }
  /// Milliseconds of "prt.vertices".
  double relight(bool half_float) {
    options_.settings = Settings(technique("prt").options);
    options_.settings.set("half_float", half_float ? "true" : "false");
    options_.settings.set("window", "none");
    double sum = 0.0;
    for (const PassTime& pass : renderer_.render(posed_, camera_, options_).passes)
      if (pass.name == "prt.vertices") sum += pass.milliseconds;
    return sum;
  }
  double bytes(bool half_float) const { return transferBytes(scene_, posed_, half_float); }
  std::size_t vertices() const {
    std::size_t sum = 0;
    for (const Instance& instance : posed_.instances)
      sum += scene_.meshes[std::size_t(instance.mesh)].vertexCount();
    return sum;
  }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  Scene scene_;
  PosedScene posed_;
  PosedCamera camera_;
  Renderer renderer_;
  RenderOptions options_;
};

struct Row {
  std::string name;
  std::size_t vertices;
  bool half_float;
  double bytes, milliseconds, copy_gb_s, ratio;
};

Row measure(Subject& subject, bool half_float, Copies& copies) {
  double relight = 1e30, copy = 1e30;
  for (int round = -kWarmUpRounds; round < kRounds; ++round) {
    if (interrupted()) throw Interrupted("interrupted: no figures");
    const double copy_ms = copies.milliseconds(), relight_ms = subject.relight(half_float);
    if (round < 0) continue;
    copy = std::min(copy, copy_ms);
    relight = std::min(relight, relight_ms);
  }
  const double rate = 2.0 * double(kCopiedBytes) / copy / 1e6;  // read and written
  const double bytes = subject.bytes(half_float);
  return {subject.name(), subject.vertices(), half_float, bytes, relight, rate, relight * rate * 1e6 / bytes};
}

struct LightRow {
  int lights;
  double coefficients_us, change_us, vertices_ms;
};

LightRow measureLights(Subject& subject, int count) {
  const AnimatedLights animated = AnimatedLights::parse(discs(count));
  LightRow row{count, lightMicroseconds(animated), 0.0, 0.0};
  std::vector<double> frames, changes;
  for (int round = -kWarmUpRounds; round < kRounds; ++round) {
    const double change = subject.light(animated, 0.1f * float(round + kWarmUpRounds));
    const double frame = subject.relight(true);
    if (round >= 0) changes.push_back(change), frames.push_back(frame);
  }
  row.vertices_ms = quantile(frames, 0.0);
  row.change_us = quantile(changes, 0.0);
  return row;
}

void print(const std::vector<Row>& rows, const std::vector<LightRow>& lights, const std::string& device,
           Console& console) {
  if (console.json) {
    Json json = Json::array(), of_lights = Json::array();
    for (const Row& row : rows)
      json.push_back({{"scene", row.name},
                      {"vertices", row.vertices},
                      {"half_float", row.half_float},
                      {"bytes", row.bytes},
                      {"vertices_ms", row.milliseconds},
                      {"copy_gb_s", row.copy_gb_s},
                      {"ratio", row.ratio}});
    for (const LightRow& row : lights)
      of_lights.push_back({{"lights", row.lights},
                           {"coefficients_us", row.coefficients_us},
                           {"change_us", row.change_us},
                           {"vertices_ms", row.vertices_ms}});
    console.print(jsonText({{"device", device}, {"rows", json}, {"lights", of_lights}}));
    return;
  }
  console.print(fmt::format("{}; copies of {} MiB, read and written; best of {} rounds", device,
                            kCopiedBytes >> 20, kRounds));
  console.print(
      "scene                      vertices  numbers  transfer MB  prt.vertices ms  copy GB/s  times bound");
  for (const Row& row : rows)
    console.print(fmt::format("{:<24} {:>10}  {:<7}  {:>11.1f}  {:>15.2f}  {:>9.2f}  {:>11.2f}", row.name,
                              countText(row.vertices), row.half_float ? "halves" : "floats", row.bytes / 1e6,
                              row.milliseconds, row.copy_gb_s, row.ratio));
  console.print("lights  keys to coefficients us  change of light us  prt.vertices ms");
  for (const LightRow& row : lights)
    console.print(fmt::format("{:>6}  {:>23.1f}  {:>18.1f}  {:>15.2f}", row.lights, row.coefficients_us,
                              row.change_us, row.vertices_ms));
}

}  // namespace

int benchRelight(const SceneChoice& choice, Console& console) {
  std::vector<Row> rows;
  std::vector<LightRow> lights;
  Copies copies;
  const auto add = [&](Subject& subject) {
    for (const bool half_float : {false, true}) rows.push_back(measure(subject, half_float, copies));
  };
  Scene given = loadSceneToDraw(choice, console);
  console.release();
  if (carriesTransfer(given)) {
    Subject subject(sceneStem(choice.name), std::move(given));
    add(subject);
  }
  for (const int count : {4000, 200000, 1000000}) {  // the first stays in caches: what instructions cost
    Subject subject("sheet", sheet(count));
    add(subject);
    if (count != 200000) continue;
    for (const int lamps : {1, 8, 64}) lights.push_back(measureLights(subject, lamps));
  }
  print(rows, lights, copies.device(), console);
  return kDone;
}

}  // namespace gloam::cli
