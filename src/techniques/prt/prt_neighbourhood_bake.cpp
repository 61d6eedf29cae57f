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
#include "techniques/prt/prt_neighbourhood_state.h"
#include "techniques/prt/prt_neighbourhood_trace.h"

namespace gloam {
namespace {

using namespace prt;

constexpr int kMostPoints = 128;  // a side

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

/// An empty grid round the object: cells are cubes unless points along each axis are given.
NeighbourhoodTransfer layOut(const NeighbourhoodObject& object, const NeighbourhoodOptions& options) {
  NeighbourhoodTransfer grid;
  grid.light_order = grid.field_order = options.order;
  const glm::vec3 side = object.bounds_max - object.bounds_min;
  const float longest = std::max({side.x, side.y, side.z});
  const glm::vec3 middle = 0.5f * (object.bounds_min + object.bounds_max);
  const glm::vec3 least(1e-3f * longest);  // of a sheet that lies in an axis' plane
  const glm::vec3 room = glm::max(side + 2.0f * options.reach * longest, least);
  grid.size = options.size;
  if (options.size.y == 0) {
    grid.spacing = glm::vec3((1.0f + 2.0f * options.reach) * longest / float(options.size.x - 1));
    grid.size = glm::clamp(glm::ivec3(glm::ceil(room / grid.spacing - 1e-3f)) + 1, 2, kMostPoints);
  } else {
    grid.spacing = room / glm::vec3(grid.size - 1);
  }
  grid.first_point = middle - 0.5f * grid.spacing * glm::vec3(grid.size - 1);
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
  estimate.rays = grid.points() * std::size_t(options.directions);
  const std::size_t visibility = grid.points() * grid.visibilityCount() * sizeof(float);
  estimate.file_bytes = visibility + thrownBytes(grid, options);
  const GlossyLayout layout{options.order, options.order};
  const int tiles = (options.directions + kTileSize - 1) / kTileSize;
  estimate.memory_bytes =
      estimate.file_bytes + grid.points() + GlossyTables::memoryBytes(layout, tiles) +
      std::size_t(options.directions) * std::size_t(3 + layout.lightCount()) * sizeof(float) +
      object.triangles * (130 + 1);
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

std::size_t bakePoint(const NeighbourhoodTracer& tracer, const glm::vec3& place, std::size_t point,
                      NeighbourhoodState& state) {
  NeighbourhoodTransfer& grid = state.grid;
  thread_local std::vector<std::uint16_t> blocked;
  const float share = tracer.visibility(place, blocked, &grid.visibility[point * grid.visibilityCount()]);
  std::size_t rays = tracer.raysOfPoint();
  state.inside[point] = share > 0.9f && tracer.isInside(place);
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
            traced += bakePoint(tracer, object.scale * state.grid.position(p), p, state);
          rays += traced;
          state.block_done[b].store(1, std::memory_order_release);
          if (!meter.blockDone(traced)) stop = true;
        }
      },
      tbb::simple_partitioner());
  if (stop) meter.interrupt();
  report.rays = rays;
}

/// Points in the object take the mean of the known ones among their 26 neighbours, nearer ones counting more, ring by ring.
void fillInside(NeighbourhoodState& state) {
  NeighbourhoodTransfer& grid = state.grid;
  std::vector<std::uint8_t> known(grid.points());
  std::vector<std::size_t> waiting;
  for (std::size_t p = 0; p < known.size(); ++p) {
    known[p] = !state.inside[p];
    if (!known[p]) waiting.push_back(p);
  }
  const glm::ivec3 size = grid.size;
  const auto fill = [&](std::size_t p) {
    const glm::ivec3 at(int(p % std::size_t(size.x)), int(p / std::size_t(size.x) % std::size_t(size.y)),
                        int(p / (std::size_t(size.x) * std::size_t(size.y))));
    std::vector<std::pair<std::size_t, float>> near;
    float sum = 0.0f;
    for (int n = 0; n < 27; ++n) {
      const glm::ivec3 step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1), q = at + step;
      if (glm::any(glm::lessThan(q, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(q, size))) continue;
      const std::size_t other =
          std::size_t(q.x) +
          std::size_t(size.x) * (std::size_t(q.y) + std::size_t(size.y) * std::size_t(q.z));
      if (!known[other]) continue;
      const glm::vec3 way = grid.spacing * glm::vec3(step);
      near.emplace_back(other, 1.0f / std::max(1e-20f, glm::dot(way, way)));
      sum += near.back().second;
    }
    const auto mix = [&](std::vector<float>& values, std::size_t row) {
      for (std::size_t i = 0; i < row && !values.empty(); ++i) {
        float value = 0.0f;
        for (const auto& [other, weight] : near) value += weight / sum * values[other * row + i];
        values[p * row + i] = value;
      }
    };
    if (near.empty()) return false;
    mix(grid.visibility, grid.visibilityCount());
    mix(grid.indirect, 3 * grid.matrixCount());
    return true;
  };
  while (!waiting.empty()) {
    std::vector<std::size_t> filled, later;
    for (const std::size_t p : waiting) (fill(p) ? filled : later).push_back(p);
    if (filled.empty()) return;  // all of it is inside
    for (const std::size_t p : filled) known[p] = 1;
    waiting.swap(later);
  }
}

double measureError(const NeighbourhoodTracer& tracer, const NeighbourhoodObject& object,
                    const NeighbourhoodTransfer& grid, int points) {
  std::vector<glm::dvec2> squares(std::size_t(points), glm::dvec2(0.0));
  tbb::parallel_for(std::size_t(0), squares.size(), [&](std::size_t s) {
    const glm::vec3 share(sampling::radicalInverse(2, s + 1), sampling::radicalInverse(3, s + 1),
                          sampling::radicalInverse(5, s + 1));
    const glm::vec3 position = grid.first_point + grid.spacing * glm::vec3(grid.size - 1) * share;
    std::vector<float> truth(grid.visibilityCount()), seems(truth.size());
    std::vector<std::uint16_t> blocked;
    const glm::vec3 place = object.scale * position;
    if (tracer.visibility(place, blocked, truth.data()) > 0.9f && tracer.isInside(place)) return;
    visibilityAt(grid, position, seems);
    squares[s] = irradianceDifference(grid.field_order, truth, seems);
  });
  glm::dvec2 sum(0.0);
  for (const glm::dvec2& square : squares) sum += square;
  return sum.y > 0.0 ? std::sqrt(sum.x / sum.y) : 0.0;
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
    state.inside.resize(grid.points());
    state.blocks = (grid.points() + kNeighbourhoodBlock - 1) / kNeighbourhoodBlock;
    state.block_done = std::make_unique<std::atomic<std::uint8_t>[]>(state.blocks);
    Fingerprint fingerprint;
    if (!options.checkpoint.empty()) {
      fingerprint = fingerprintOf(scene, node, options);
      done.resumed = readNeighbourhood(options.checkpoint, fingerprint, state);
    }
    NeighbourhoodMeter meter(progress, options.checkpoint, fingerprint, state);
    bakePoints(tracer, object, state, meter, done);
    if (options.keep_checkpoint) meter.keepAll();
    fillInside(state);
    done.points = grid.points();
    done.inside = std::size_t(std::ranges::count(state.inside, std::uint8_t(1)));
    done.error = measureError(tracer, object, grid, options.error_points);
  });
  std::error_code ignored;
  if (!options.checkpoint.empty() && !options.keep_checkpoint)
    std::filesystem::remove(options.checkpoint, ignored);
  done.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return std::move(state.grid);
}

}  // namespace gloam
