// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baking a neighbourhood: Sloan, Kautz, Snyder 2002, section 7 (PRT-6), in order. prt_neighbourhood_trace.cpp has the
// mathematics.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "scene/machine_memory.h"
#include "scene/threads.h"
#include "techniques/prt/prt_bake_kernels.h"
#include "techniques/prt/prt_neighbourhood_field.h"
#include "techniques/prt/prt_neighbourhood_fit.h"
#include "techniques/prt/prt_neighbourhood_state.h"
#include "techniques/prt/prt_neighbourhood_trace.h"

namespace gloam {
namespace {

using namespace prt;

constexpr int kMostPoints = 128;       // a side
constexpr float kLeastGrowth = 0.15f;  // of the longest side
constexpr float kNear = 0.25f;         // the same: how far from the object's box errors count as near

void checkRange(const char* name, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw Error("neighbourhood", fmt::format("{} is {}; expected {} to {}", name, value, low, high));
}

void checkOptions(const NeighbourhoodOptions& options) {
  checkRange("size.x", options.size.x, 2, kMostPoints);
  if (options.size.y != 0 || options.size.z != 0) {
    checkRange("size.y", options.size.y, 2, kMostPoints);
    checkRange("size.z", options.size.z, 2, kMostPoints);
  } else {
    checkRange("size", options.size.x, 4, kMostPoints);
  }
  checkRange("reach", options.reach, 0, 16);
  checkRange("order", options.order, 3, 6);
  checkRange("directions", options.directions, 256, 65536);
  checkRange("thrown_directions", options.thrown_directions, 64, 65536);
  checkRange("threads", options.threads, 0, 1024);
  checkRange("error_points", options.error_points, 0, 1000000);
}

/// An empty grid round the object: even in its box, cells grow with distance beyond it. Along an axis in which the object is
/// thin they grow from where it is thick as a part of its longest side.
NeighbourhoodTransfer layOut(const NeighbourhoodObject& object, const NeighbourhoodOptions& options) {
  NeighbourhoodTransfer grid;
  grid.light_order = grid.field_order = options.order;
  const glm::vec3 side = object.bounds_max - object.bounds_min;
  const float longest = std::max({side.x, side.y, side.z});
  grid.size = options.size.y == 0 ? glm::ivec3(options.size.x) : options.size;
  grid.centre = 0.5f * (object.bounds_min + object.bounds_max);
  grid.core = 0.5f * side;
  grid.growth = glm::max(grid.core, glm::vec3(kLeastGrowth * longest));
  const glm::vec3 beyond = glm::max(glm::vec3(options.reach * longest), 5e-4f * longest - grid.core);
  grid.spacing =
      2.0f * (grid.core + grid.growth * glm::log(1.0f + beyond / grid.growth)) / glm::vec3(grid.size - 1);
  return grid;
}

std::size_t thrownBytes(const NeighbourhoodTransfer& grid, const NeighbourhoodOptions& options) {
  return options.thrown ? grid.points() * 3 * grid.matrixCount() * sizeof(float) : 0;
}

NeighbourhoodEstimate estimateOf(const NeighbourhoodObject& object, const NeighbourhoodTransfer& grid,
                                 const NeighbourhoodOptions& options) {
  NeighbourhoodEstimate estimate;
  estimate.size = grid.size;
  estimate.points = grid.points();
  estimate.rays = grid.points() * std::size_t(options.directions + kCellSamples * sampleDirections(options));
  const std::size_t visibility = grid.points() * grid.visibilityCount() * sizeof(float);
  estimate.file_bytes = visibility + thrownBytes(grid, options);
  const GlossyLayout layout{options.order, options.order};
  const int tiles = (options.directions + kTileSize - 1) / kTileSize;
  estimate.memory_bytes =
      estimate.file_bytes + grid.points() + GlossyTables::memoryBytes(layout, tiles) +
      std::size_t(options.directions) * std::size_t(3 + layout.lightCount()) * sizeof(float) +
      object.triangles * (130 + 1) + grid.points() * NeighbourhoodState::sampleBytes(grid);
  if (options.thrown)
    estimate.memory_bytes += object.vertices * (3 * layout.columnStride() * sizeof(float) + 12);
  return estimate;
}

void refuseWhatIsTooLarge(const NeighbourhoodEstimate& estimate, const NeighbourhoodOptions& options) {
  const std::size_t most = options.memory_bytes > 0 ? options.memory_bytes : memoryOfMachine();
  if (estimate.memory_bytes <= most) return;
  throw Error("neighbourhood",
              fmt::format("a grid of {} x {} x {} points takes {} MiB, there are {} MiB: take fewer points "
                          "or a lower order",
                          estimate.size.x, estimate.size.y, estimate.size.z, estimate.memory_bytes >> 20,
                          most >> 20));
}

/// The cell above a point, at places between which the grid is fitted.
std::size_t sampleCell(const NeighbourhoodTracer& tracer, const glm::mat3& scale, std::size_t point,
                       NeighbourhoodState& state) {
  const glm::ivec3 corner = state.grid.pointAt(point);
  if (glm::any(glm::greaterThanEqual(corner, state.grid.size - 1))) return 0;
  for (std::size_t k = 0; k < kCellSamples; ++k) {
    const glm::vec3 place = scale * state.grid.position(glm::vec3(corner) + cellSample(k));
    const std::size_t at = point * kCellSamples + k;
    const float share = tracer.roughVisibility(place, &state.samples[at * state.grid.visibilityCount()]);
    state.sample_inside[at] = share > 0.9f && tracer.isInside(place);
  }
  return kCellSamples * tracer.raysOfSample();
}

std::size_t bakePoint(const NeighbourhoodTracer& tracer, const glm::mat3& scale, std::size_t point,
                      NeighbourhoodState& state) {
  NeighbourhoodTransfer& grid = state.grid;
  const glm::vec3 place = scale * grid.position(point);
  thread_local std::vector<std::uint16_t> blocked;
  const float share = tracer.visibility(place, blocked, &grid.visibility[point * grid.visibilityCount()]);
  std::size_t rays = tracer.raysOfPoint();
  state.inside[point] = share > 0.9f && tracer.isInside(place);
  rays += sampleCell(tracer, scale, point, state);
  if (state.inside[point] || grid.indirect.empty()) return rays;
  const GlossyLayout& layout = tracer.layout();
  std::vector<float> matrix(layout.matrixSize() + kRowPadding, 0.0f);
  rays += tracer.thrown(place, blocked, share, matrix.data());
  const std::size_t columns = std::size_t(layout.lightCount()), rows = std::size_t(layout.fieldCount());
  float* to = &grid.indirect[point * 3 * grid.matrixCount()];
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j)
      for (std::size_t c = 0; c < 3; ++c)
        *to++ = matrix[c * layout.colorSize() + i * layout.columnStride() + j];
  return rays;
}

void bakePoints(const NeighbourhoodTracer& tracer, const NeighbourhoodObject& object,
                NeighbourhoodState& state, NeighbourhoodMeter& meter, NeighbourhoodReport& report) {
  std::atomic<std::size_t> rays{0};
  std::atomic<bool> stop{false};
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, state.blocks, 1),
      [&](const auto& range) {
        for (std::size_t b = range.begin(); b != range.end() && !stop; ++b) {
          if (state.block_done[b].load(std::memory_order_relaxed)) continue;
          std::size_t traced = 0;
          for (std::size_t p = state.blockBegin(b); p < state.blockEnd(b); ++p)
            traced += bakePoint(tracer, object.scale, p, state);
          rays += traced;
          state.block_done[b].store(1, std::memory_order_release);
          if (!meter.blockDone(traced)) stop = true;
        }
      },
      tbb::simple_partitioner());
  if (stop) meter.interrupt();
  report.rays = rays;
}

/// Squared difference and squared irradiance at one place, 0 inside the object.
glm::dvec2 errorAt(const NeighbourhoodTracer& tracer, const NeighbourhoodObject& object,
                   const NeighbourhoodTransfer& grid, const glm::vec3& position) {
  std::vector<float> truth(grid.visibilityCount()), seems(truth.size());
  std::vector<std::uint16_t> blocked;
  const glm::vec3 place = object.scale * position;
  if (tracer.visibility(place, blocked, truth.data()) > 0.9f && tracer.isInside(place)) return {};
  visibilityAt(grid, position, seems);
  return irradianceDifference(grid.field_order, truth, seems);
}

/// At random in the grid, and as often near the object.
void measureError(const NeighbourhoodTracer& tracer, const NeighbourhoodObject& object,
                  const NeighbourhoodTransfer& grid, int points, NeighbourhoodReport& report) {
  const glm::vec3 side = object.bounds_max - object.bounds_min;
  const glm::vec3 half = grid.half(), margin(kNear * std::max({side.x, side.y, side.z}));
  const glm::vec3 near_half = glm::min(half, 0.5f * side + margin);
  std::vector<glm::dvec2> squares(2 * std::size_t(points), glm::dvec2(0.0));
  tbb::parallel_for(std::size_t(0), squares.size(), [&](std::size_t s) {
    const glm::vec3 way(sampling::radicalInverse(2, s / 2 + 1), sampling::radicalInverse(3, s / 2 + 1),
                        sampling::radicalInverse(5, s / 2 + 1));
    const glm::vec3 reach = s % 2 == 0 ? half : near_half;
    squares[s] = errorAt(tracer, object, grid, grid.centre + reach * (2.0f * way - 1.0f));
  });
  glm::dvec2 sum[2] = {};
  double worst = 0.0, counted = 0.0;
  for (std::size_t s = 0; s < squares.size(); ++s) {
    sum[s % 2] += squares[s];
    if (s % 2 == 0 || squares[s].y == 0.0) continue;
    worst = std::max(worst, squares[s].x);
    counted += 1.0;
  }
  report.error = sum[0].y > 0.0 ? std::sqrt(sum[0].x / sum[0].y) : 0.0;
  report.near_error = sum[1].y > 0.0 ? std::sqrt(sum[1].x / sum[1].y) : 0.0;
  report.worst_error = sum[1].y > 0.0 ? std::sqrt(worst / (sum[1].y / counted)) : 0.0;
}

Fingerprint fingerprintOf(const Scene& scene, int node, const NeighbourhoodOptions& options) {
  Fingerprint print;
  add(print, scene);
  const auto& [size, reach, order, thrown, directions, thrown_directions, threads, time_s, memory_bytes,
               error_points, checkpoint, keep_checkpoint] = options;
  addAll(print, node, size, reach, order, thrown, directions, thrown_directions, time_s,
         std::string(kernelTarget()));
  return print;
}

}  // namespace

NeighbourhoodEstimate estimateNeighbourhood(const Scene& scene, int node,
                                            const NeighbourhoodOptions& options) {
  checkOptions(options);
  const NeighbourhoodObject object = neighbourhoodObject(scene, node, options.time_s);
  return estimateOf(object, layOut(object, options), options);
}

NeighbourhoodTransfer bakeNeighbourhood(const Scene& scene, int node, const NeighbourhoodOptions& options,
                                        const Progress& progress, NeighbourhoodReport* report) {
  checkOptions(options);
  const NeighbourhoodObject object = neighbourhoodObject(scene, node, options.time_s);
  NeighbourhoodState state;
  state.grid = layOut(object, options);
  refuseWhatIsTooLarge(estimateOf(object, state.grid, options), options);
  NeighbourhoodReport local;
  NeighbourhoodReport& done = report ? *report : local;
  done = {};
  const auto start = std::chrono::steady_clock::now();
  withThreads(options.threads, [&] {
    const NeighbourhoodTracer tracer(scene, object, options, progress);
    NeighbourhoodTransfer& grid = state.grid;
    grid.bounces = tracer.bounces();
    grid.visibility.resize(grid.points() * grid.visibilityCount());
    if (tracer.throws()) grid.indirect.resize(grid.points() * 3 * grid.matrixCount());
    state.begin();
    Fingerprint fingerprint;
    if (!options.checkpoint.empty()) {
      fingerprint = fingerprintOf(scene, node, options);
      done.resumed = readNeighbourhood(options.checkpoint, fingerprint, state);
    }
    NeighbourhoodMeter meter(progress, options.checkpoint, fingerprint, state);
    bakePoints(tracer, object, state, meter, done);
    if (options.keep_checkpoint) meter.keepAll();
    fillInside(state);
    fitVisibility(state);
    fitThrown(state);
    done.points = grid.points();
    done.inside = std::size_t(std::ranges::count(state.inside, std::uint8_t(1)));
    measureError(tracer, object, grid, options.error_points, done);
  });
  std::error_code ignored;
  if (!options.checkpoint.empty() && !options.keep_checkpoint)
    std::filesystem::remove(options.checkpoint, ignored);
  done.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return std::move(state.grid);
}

}  // namespace gloam
