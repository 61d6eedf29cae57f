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
#include <mutex>
#include <optional>

#include "math/sampling.h"
#include "scene/machine_memory.h"
#include "scene/threads.h"
#include "scene/transforms.h"
#include "scene/volume_places.h"
#include "techniques/prt/prt_volume_march.h"
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

/// Tells how far the bake is and asks whether to stop; called by all threads.
class VolumeMeter {
 public:
  VolumeMeter(const Progress& progress, double work) : progress_(progress), work_(work) {}
  /// False to stop.
  bool done(double work, const char* what) {
    const std::scoped_lock lock(mutex_);
    done_ += work;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ > std::chrono::milliseconds(100)) {
      last_ = now;
      progress_.report(std::min(1.0, done_ / work_), what);
      stopped_ = stopped_ || progress_.stopRequested();
    }
    return !stopped_;
  }

 private:
  const Progress& progress_;
  const double work_;
  double done_ = 0.0;
  bool stopped_ = false;
  std::chrono::steady_clock::time_point last_{};
  std::mutex mutex_;
};

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

/// One volume's passes. Rows of all voxels lie end to end, [filled voxel][coefficient].
class VolumeBake {
 public:
  VolumeBake(const Volume& volume, const Blockers& blockers, const VolumeBakeOptions& options,
             VolumeMeter& meter)
      : volume_(volume),
        blockers_(blockers),
        options_(options),
        meter_(meter),
        even_(evenMedium(volume)),
        marcher_(volume, even_.extinction, glm::inverse(blockers.scale)),
        coefficients_(std::size_t(options.order * options.order)),
        row_((coefficients_ + 3) / 4 * 4) {}

  Transfer run(double* last_order);

 private:
  template <class Work>
  void eachVoxel(double work, const char* what, const Work& work_on) const;
  void lookOut(std::vector<float>& rows) const;
  void scatter(const std::vector<float>& from, std::vector<float>& to) const;
  double constantOf(const std::vector<float>& rows) const;

  const Volume& volume_;
  const Blockers& blockers_;
  const VolumeBakeOptions& options_;
  VolumeMeter& meter_;
  EvenMedium even_;
  VolumeMarcher marcher_;
  std::size_t coefficients_, row_;
};

template <class Work>
void VolumeBake::eachVoxel(double work, const char* what, const Work& work_on) const {
  std::atomic<bool> stop{false};
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, marcher_.filled().size(), 256),
      [&](const auto& range) {
        if (stop) return;
        for (std::size_t v = range.begin(); v != range.end(); ++v) work_on(v);
        if (!meter_.done(work * double(range.size()), what)) stop = true;
      },
      tbb::simple_partitioner());
  if (stop) throw Interrupted("interrupted while baking a volume; volumes begin anew");
}

void VolumeBake::lookOut(std::vector<float>& rows) const {
  const std::vector<glm::vec3> directions = sampling::fibonacciSphere(options_.directions);
  std::vector<float> basis(directions.size() * row_, 0.0f);
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const sh::Sh y = sh::evaluate(options_.order, directions[d]);
    for (std::size_t i = 0; i < coefficients_; ++i) basis[d * row_ + i] = y[int(i)];
  }
  eachVoxel(double(directions.size()), "volume: light that arrives", [&](std::size_t v) {
    const std::uint32_t voxel = marcher_.filled()[v];
    float* row = &rows[v * row_];
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const float through = std::exp(-marcher_.opticalDepth(voxel, directions[d]));
      if (through < 1e-5f) continue;
      if (blockers_.tracer &&
          blockers_.tracer->occluded(
              {.origin = blockers_.scale * marcher_.position(voxel), .direction = directions[d]}))
        continue;
      const float weight = through / float(directions.size());
      const float* y = &basis[d * row_];
      for (std::size_t i = 0; i < row_; ++i) row[i] += weight * y[i];
    }
  });
}

void VolumeBake::scatter(const std::vector<float>& from, std::vector<float>& to) const {
  const std::vector<glm::vec3> directions = sampling::fibonacciSphere(options_.scatter_directions);
  eachVoxel(double(directions.size()), "volume: scattering", [&](std::size_t v) {
    thread_local std::vector<Gathered> gathered;
    gathered.clear();
    for (const glm::vec3& direction : directions) marcher_.gather(marcher_.filled()[v], direction, gathered);
    float sum[sh::kMaxOrder * sh::kMaxOrder + 4] = {};
    for (const Gathered& share : gathered) {
      const float* row = &from[share.voxel * row_];
      for (std::size_t i = 0; i < row_; ++i) sum[i] += share.weight * row[i];
    }
    for (std::size_t i = 0; i < row_; ++i) to[v * row_ + i] = sum[i] / float(directions.size());
  });
}

/// The sum of constant parts: what even light gives.
double VolumeBake::constantOf(const std::vector<float>& rows) const {
  double sum = 0.0;
  for (std::size_t v = 0; v < marcher_.filled().size(); ++v) sum += double(rows[v * row_]);
  return sum;
}

Transfer VolumeBake::run(double* last_order) {
  const std::vector<std::uint32_t>& filled = marcher_.filled();
  Transfer transfer;
  transfer.order = options_.order;
  transfer.bounces = options_.scatterings - 1;
  transfer.directions = options_.directions;
  std::vector<float> now(filled.size() * row_, 0.0f), next(now.size());
  lookOut(now);
  const auto spread = [&](const std::vector<float>& rows, const glm::vec3& factor, std::size_t colors,
                          std::vector<float>& values) {
    for (std::size_t v = 0; v < filled.size(); ++v)
      for (std::size_t i = 0; i < coefficients_; ++i)
        for (std::size_t c = 0; c < colors; ++c)
          values[(filled[v] * coefficients_ + i) * colors + c] += factor[int(c)] * rows[v * row_ + i];
  };
  transfer.direct.assign(volume_.voxels() * coefficients_, 0.0f);
  spread(now, glm::vec3(1.0f), 1, transfer.direct);
  double all = constantOf(now), last = all;
  const double mean = double(even_.albedo.x + even_.albedo.y + even_.albedo.z) / 3.0;
  if (transfer.bounces > 0) transfer.indirect.assign(3 * transfer.direct.size(), 0.0f);
  glm::vec3 factor(1.0f);
  for (int b = 1; b <= transfer.bounces; ++b) {
    scatter(now, next);
    now.swap(next);
    factor *= even_.albedo;
    spread(now, factor, 3, transfer.indirect);
    last = std::pow(mean, b) * constantOf(now);
    all += last;
  }
  *last_order = all > 0.0 && transfer.bounces > 0 ? last / all : 0.0;
  return transfer;
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
  Scene baked = scene;
  const PosedScene posed = pose(scene, options.time_s);
  VolumeReport done;
  const double each =
      double(options.directions) + double(options.scatterings - 1) * double(options.scatter_directions);
  VolumeMeter meter(progress, double(estimate.filled) * each);
  withThreads(options.threads, [&] {
    for (const PlacedVolume& placed : VolumePlaces(scene).at(options.time_s)) {
      const std::size_t node = std::size_t(placed.node);
      const Blockers blockers = blockersOf(scene, posed, placed.world_from_node, placeOf(scene, node), {});
      auto volume = std::make_shared<Volume>(*placed.volume);
      double last = 0.0;
      volume->transfer =
          std::make_shared<Transfer>(VolumeBake(*placed.volume, blockers, options, meter).run(&last));
      baked.nodes[node].volume = std::move(volume);
      ++done.volumes;
      done.last_order = std::max(done.last_order, last);
    }
  });
  done.filled = estimate.filled;
  done.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (report) *report = done;
  return baked;
}

}  // namespace gloam
