// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference/reference_bench.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <thread>
#include <vector>

#include "reference/integrator.h"

namespace gloam {
namespace {

using namespace reference;

constexpr int kTileSize = 16;                            // as the path tracer's own
constexpr std::size_t kMostRays = std::size_t(1) << 22;  // recorded, 36 bytes each

struct Tile {
  struct Place {
    CameraPoint point;
    int x, y;
  };
  std::vector<Place> places;
  std::vector<trace::LoggedRay> rays;
  double bare_s = 0.0, paths_s = 0.0;  // of one round
};

// Of this thread where such a clock is: others that use the machine count less.
double processorSeconds() {
#ifdef CLOCK_THREAD_CPUTIME_ID
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
#else
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
#endif
}

template <class Work>
void forTiles(std::vector<Tile>& tiles, const Work& work) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, tiles.size(), 1),
      [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) work(tiles[i]);
      },
      tbb::simple_partitioner());
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

class Measurement {
 public:
  Measurement(const Integrator& integrator, int width, int samples)
      : integrator_(integrator), width_(width), samples_(samples) {}

  void trace(Tile& tile, std::vector<trace::LoggedRay>* log) const {
    std::size_t rays = 0;
    float sum = 0.0f;
    std::vector<PathLight> lights(static_cast<std::size_t>(samples_));
    for (const Tile::Place& place : tile.places) {
      const auto pixel = std::uint32_t(place.y * width_ + place.x);
      integrator_.trace(place.point, place.x, place.y, pixel, 0, lights, rays, log);
      sum += lights[0][kSeen].g;
    }
    keep(sum);
  }
  /// Both sides in turn, tile by tile.
  void time(Tile& tile, bool bare_first) const {
    for (const bool bare : {bare_first, !bare_first}) {
      const double start = processorSeconds();
      bare ? replay(tile) : trace(tile, nullptr);
      (bare ? tile.bare_s : tile.paths_s) = processorSeconds() - start;
    }
  }
  void replay(const Tile& tile) const { keep(float(integrator_.tracer().replay(tile.rays))); }

 private:
  // What is not used might not be worked out.
  void keep(float value) const { kept_.store(value, std::memory_order_relaxed); }
  const Integrator& integrator_;
  const int width_, samples_;
  mutable std::atomic<float> kept_{0.0f};
};

// Every n-th tile of the picture in checkered order, so that their rays fit into memory; those that see a surface.
std::vector<Tile> tilesOf(const Integrator& integrator, int width, int height, int samples) {
  const int across = (width + kTileSize - 1) / kTileSize, down = (height + kTileSize - 1) / kTileSize;
  const std::size_t rays =
      std::size_t(across) * std::size_t(down) * kTileSize * kTileSize * 4 * std::size_t(samples);
  const int step = int(rays / kMostRays) + 1;
  std::vector<Tile> tiles;
  for (int t = 0; t < across * down; t += step) {
    Tile tile;
    const int x0 = (t % across + (step > 1 ? t / across : 0)) % across * kTileSize,
              y0 = t / across * kTileSize;
    for (int y = y0; y < std::min(y0 + kTileSize, height); ++y) {
      for (int x = x0; x < std::min(x0 + kTileSize, width); ++x) {
        const CameraPoint point = integrator.look(x, y);
        if (point.instance != kNone) tile.places.push_back({point, x, y});
      }
    }
    if (!tile.places.empty()) tiles.push_back(std::move(tile));
  }
  return tiles;
}

ReferenceBench measure(const Integrator& integrator, const ReferenceOptions& options, int samples,
                       int rounds) {
  const int width = options.width * options.supersample, height = options.height * options.supersample;
  std::vector<Tile> tiles = tilesOf(integrator, width, height, samples);
  const Measurement measurement(integrator, width, samples);
  ReferenceBench bench;
  bench.triangles = integrator.tracer().triangleCount();
  bench.samples = samples;
  bench.rounds = rounds;
  forTiles(tiles, [&](Tile& tile) { measurement.trace(tile, &tile.rays); });
  for (const Tile& tile : tiles) {
    bench.points += tile.places.size();
    bench.rays += tile.rays.size();
  }
  if (bench.rays == 0) throw Error("bench reference", "the picture shows no lit surface");
  std::vector<double> bare, paths, ratio;
  for (int round = 0; round < rounds; ++round) {
    forTiles(tiles, [&](Tile& tile) { measurement.time(tile, round % 2 == 0); });
    double bare_s = 0.0, paths_s = 0.0;
    for (const Tile& tile : tiles) bare_s += tile.bare_s, paths_s += tile.paths_s;
    bare.push_back(double(bench.rays) * 1e-6 / bare_s);
    paths.push_back(double(bench.rays) * 1e-6 / paths_s);
    ratio.push_back(bare_s / paths_s);
  }
  bench.bare_mrays_s = median(bare);
  bench.paths_mrays_s = median(paths);
  bench.ratio = median(ratio);
  return bench;
}

}  // namespace

ReferenceBench benchReference(const Scene& scene, const PosedScene& posed, const PosedCamera& camera,
                              const Environment& environment, const ReferenceOptions& options, int samples,
                              int rounds) {
  const Integrator integrator(scene, posed, camera, environment, options, {});
  const int cores =
      options.threads > 0 ? options.threads : std::max(1, int(std::thread::hardware_concurrency()));
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, std::size_t(cores));
  ReferenceBench bench;
  tbb::task_arena(cores).execute(
      [&] { bench = measure(integrator, options, std::max(1, samples), std::max(1, rounds)); });
  return bench;
}

}  // namespace gloam
