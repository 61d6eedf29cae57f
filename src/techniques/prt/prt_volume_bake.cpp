// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baking volumes: Sloan, Kautz, Snyder 2002, section 6 (PRT-7). Light that arrives unscattered, as the mean over directions,
//   J0_i(p) = 1/4pi integral of V(p, s) T(p, s) y_i(s) ds,
// then one order of scattering after the other, gathered from the voxels along each direction,
//   K_b(p) = 1/4pi integral over s of the integral of T(p, q) sigma*(q) K_(b-1)(q) dq,   K_0 = J0,
// which albedo only scales: J = sum of a*^b K_b in each colour. Differs from the paper: phase functions that are not even are
// taken by the similarity relation (prt_volume_march.h).
#include <fmt/format.h>
#include <gloam/sh.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>

#include "math/sampling.h"
#include "scene/machine_memory.h"
#include "scene/threads.h"
#include "scene/transforms.h"
#include "scene/volume_places.h"
#include "techniques/prt/prt_volume_march.h"
#include "techniques/prt/prt_volume_state.h"
#include "trace/tracer.h"

namespace gloam {
namespace {

using namespace prt;

void checkRange(const char* name, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw Error("volumes", fmt::format("{} is {}; expected {} to {}", name, value, low, high));
}

void checkOptions(const VolumeBakeOptions& options) {
  checkRange("order", options.order, 3, 6);
  checkRange("scatterings", options.scatterings, 1, 256);
  checkRange("directions", options.directions, 64, 65536);
  checkRange("scatter_directions", options.scatter_directions, 16, 65536);
  checkRange("threads", options.threads, 0, 1024);
}

std::string placeOf(const Scene& scene, std::size_t node) {
  return "node '" + scene.nodes[node].name + "'";
}

std::size_t filledVoxels(const Volume& volume) {
  return VolumeMarcher(volume, 1.0f).filled().size();
}

/// What stands in the light's way, in the axes of the volume's node.
struct Blockers {
  glm::mat3 scale{1.0f};  // from the node's coordinates to these axes
  PosedScene posed;
  std::optional<trace::Tracer> tracer;
};

Blockers blockersOf(const Scene& scene, PosedScene posed, const glm::mat4& world_from_node,
                    const std::string& place, const Progress& progress) {
  Blockers blockers;
  const glm::mat3 turn = rotationFactor(world_from_node);
  glm::mat4 axes_from_world(glm::transpose(turn));
  axes_from_world[3] = glm::vec4(-(glm::transpose(turn) * glm::vec3(world_from_node[3])), 1.0f);
  blockers.scale = glm::transpose(turn) * glm::mat3(world_from_node);
  if (!(std::abs(glm::determinant(blockers.scale)) > 1e-30f))
    throw Error(place, "its scale is 0: there is no room for a volume");
  std::erase_if(posed.instances, [](const Instance& instance) { return instance.deformed(); });
  for (Instance& instance : posed.instances)
    instance.world_from_object = axes_from_world * instance.world_from_object;
  blockers.posed = std::move(posed);
  if (!blockers.posed.instances.empty())
    blockers.tracer.emplace(scene, blockers.posed, trace::TracerOptions{.rigid_only = true}, progress);
  return blockers;
}

/// One volume's passes.
class VolumeBake {
 public:
  VolumeBake(const Volume& volume, const Blockers& blockers, const VolumeBakeOptions& options,
             VolumeState& state, VolumeMeter& meter)
      : blockers_(blockers),
        options_(options),
        state_(state),
        meter_(meter),
        even_(evenMedium(volume)),
        marcher_(volume, even_.extinction, glm::inverse(blockers.scale)),
        coefficients_(std::size_t(options.order * options.order)) {
    if (!state.begun()) state.begin(volume, marcher_.filled().size(), options);
  }

  void run();

 private:
  template <class Work>
  void eachVoxel(const Work& work_on) const;
  void lookOut() const;
  void scatter() const;
  void spread(const glm::vec3& factor, std::size_t colors, std::vector<float>& values) const;
  void finishPass();

  const Blockers& blockers_;
  const VolumeBakeOptions& options_;
  VolumeState& state_;
  VolumeMeter& meter_;
  EvenMedium even_;
  VolumeMarcher marcher_;
  std::size_t coefficients_;
};

template <class Work>
void VolumeBake::eachVoxel(const Work& work_on) const {
  std::atomic<bool> stop{false};
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, state_.blocks, 1),
      [&](const auto& range) {
        for (std::size_t b = range.begin(); b != range.end() && !stop; ++b) {
          if (state_.block_done[b].load(std::memory_order_relaxed)) continue;
          for (std::size_t v = state_.blockBegin(b); v < state_.blockEnd(b); ++v)
            work_on(v, &state_.next[v * state_.row]);
          state_.block_done[b].store(1, std::memory_order_release);
          if (!meter_.blockDone()) stop = true;
        }
      },
      tbb::simple_partitioner());
  if (stop) meter_.interrupt();
}

void VolumeBake::lookOut() const {
  const std::size_t width = state_.row;
  const std::vector<glm::vec3> directions = sampling::fibonacciSphere(options_.directions);
  std::vector<float> basis(directions.size() * width, 0.0f);
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const sh::Sh y = sh::evaluate(options_.order, directions[d]);
    for (std::size_t i = 0; i < coefficients_; ++i) basis[d * width + i] = y[int(i)];
  }
  eachVoxel([&](std::size_t v, float* row) {
    const std::uint32_t voxel = marcher_.filled()[v];
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const float through = std::exp(-marcher_.opticalDepth(voxel, directions[d]));
      if (through < 1e-5f) continue;
      if (blockers_.tracer &&
          blockers_.tracer->occluded(
              {.origin = blockers_.scale * marcher_.position(voxel), .direction = directions[d]}))
        continue;
      const float weight = through / float(directions.size());
      const float* y = &basis[d * width];
      for (std::size_t i = 0; i < width; ++i) row[i] += weight * y[i];
    }
  });
}

void VolumeBake::scatter() const {
  const std::size_t width = state_.row;
  const std::vector<glm::vec3> directions = sampling::fibonacciSphere(options_.scatter_directions);
  eachVoxel([&](std::size_t v, float* to) {
    thread_local std::vector<Gathered> gathered;
    gathered.clear();
    for (const glm::vec3& direction : directions) marcher_.gather(marcher_.filled()[v], direction, gathered);
    float sum[sh::kMaxOrder * sh::kMaxOrder + 4] = {};
    for (const Gathered& share : gathered) {
      const float* row = &state_.now[share.voxel * width];
      for (std::size_t i = 0; i < width; ++i) sum[i] += share.weight * row[i];
    }
    for (std::size_t i = 0; i < width; ++i) to[i] = sum[i] / float(directions.size());
  });
}

void VolumeBake::spread(const glm::vec3& factor, std::size_t colors, std::vector<float>& values) const {
  for (std::size_t v = 0; v < state_.filled; ++v)
    for (std::size_t i = 0; i < coefficients_; ++i)
      for (std::size_t c = 0; c < colors; ++c)
        values[(marcher_.filled()[v] * coefficients_ + i) * colors + c] +=
            factor[int(c)] * state_.now[v * state_.row + i];
}

void VolumeBake::finishPass() {
  state_.now.swap(state_.next);
  glm::vec3 factor(1.0f);
  for (int b = 0; b < state_.pass; ++b) factor *= even_.albedo;
  if (state_.pass == 0)
    spread(factor, 1, state_.transfer.direct);
  else
    spread(factor, 3, state_.transfer.indirect);
  double even = 0.0;
  for (std::size_t v = 0; v < state_.filled; ++v) even += double(state_.now[v * state_.row]);
  const double mean = double(even_.albedo.x + even_.albedo.y + even_.albedo.z) / 3.0;
  state_.even_last = std::pow(mean, state_.pass) * even;
  state_.even += state_.even_last;
  state_.nextPass();
}

void VolumeBake::run() {
  while (!state_.finished()) {
    if (state_.pass == 0)
      lookOut();
    else
      scatter();
    finishPass();
  }
}

std::size_t memoryOf(const Volume& volume, std::size_t filled, const VolumeBakeOptions& options) {
  const std::size_t n = std::size_t(options.order * options.order);
  const std::size_t colors = options.scatterings > 1 ? 4 : 1;
  return volume.voxels() * (n * colors + 3) * sizeof(float) + 2 * filled * (n + 4) * sizeof(float);
}

void refuseWhatIsTooLarge(const VolumeEstimate& estimate, const VolumeBakeOptions& options) {
  const std::size_t most = options.memory_bytes > 0 ? options.memory_bytes : memoryOfMachine();
  if (estimate.memory_bytes > most)
    throw Error("volumes",
                fmt::format("the largest takes {} MiB to bake, {} MiB are granted: take fewer voxels or a "
                            "lower order",
                            estimate.memory_bytes >> 20, most >> 20));
}

}  // namespace

VolumeEstimate estimateVolumes(const Scene& scene, const VolumeBakeOptions& options) {
  checkOptions(options);
  VolumeEstimate estimate;
  const std::size_t n = std::size_t(options.order * options.order);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (!scene.nodes[i].volume) continue;
    const Volume& volume = *scene.nodes[i].volume;
    checkVolume(volume, placeOf(scene, i));
    const std::size_t filled = filledVoxels(volume);
    ++estimate.volumes;
    estimate.voxels += volume.voxels();
    estimate.filled += filled;
    estimate.file_bytes += volume.voxels() * (1 + n * (options.scatterings > 1 ? 4 : 1)) * sizeof(float);
    estimate.memory_bytes = std::max(estimate.memory_bytes, memoryOf(volume, filled, options));
  }
  return estimate;
}

Scene bakeVolumes(const Scene& scene, const VolumeBakeOptions& options, const Progress& progress,
                  VolumeReport* report) {
  const VolumeEstimate estimate = estimateVolumes(scene, options);
  refuseWhatIsTooLarge(estimate, options);
  const auto start = std::chrono::steady_clock::now();
  const PosedScene posed = pose(scene, options.time_s);
  const std::vector<PlacedVolume> placed = VolumePlaces(scene).at(options.time_s);
  std::vector<const Volume*> volumes;
  std::vector<std::size_t> filled;
  for (const PlacedVolume& p : placed) {
    volumes.push_back(p.volume.get());
    filled.push_back(filledVoxels(*p.volume));
  }
  std::vector<VolumeState> states(placed.size());
  VolumeReport done;
  VolumeMeter meter(scene, volumes, filled, options, progress, states);
  done.resumed = meter.resumed();
  withThreads(options.threads, [&] {
    for (std::size_t v = 0; v < placed.size(); ++v) {
      if (states[v].finished()) continue;
      const std::string place = placeOf(scene, std::size_t(placed[v].node));
      const Blockers blockers = blockersOf(scene, posed, placed[v].world_from_node, place, {});
      VolumeBake(*volumes[v], blockers, options, states[v], meter).run();
    }
  });
  meter.end();
  Scene baked = scene;
  for (std::size_t v = 0; v < placed.size(); ++v) {
    VolumeState& state = states[v];
    auto volume = std::make_shared<Volume>(*volumes[v]);
    volume->transfer = std::make_shared<Transfer>(std::move(state.transfer));
    baked.nodes[std::size_t(placed[v].node)].volume = std::move(volume);
    ++done.volumes;
    if (state.passes > 1 && state.even > 0.0)
      done.last_order = std::max(done.last_order, state.even_last / state.even);
  }
  done.filled = estimate.filled;
  done.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (report) *report = done;
  return baked;
}

}  // namespace gloam
