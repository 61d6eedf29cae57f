// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The work itself: looking through every pixel once, then samples, tile by tile on all cores.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <array>
#include <bit>
#include <chrono>
#include <mutex>

#include "reference/path_tracer_state.h"
#include "scene/threads.h"

namespace gloam::reference {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxPointBytes = std::size_t(512) << 20;  // of camera points that are kept
constexpr double kRoundSeconds = 0.2;
constexpr int kMaxRoundSamples = 256;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// One thread at a time looks after whoever watches, the others go on.
class Attendant {
 public:
  explicit Attendant(std::function<bool()> look) : look_(std::move(look)) {}
  bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
  void call() {
    constexpr auto kInterval = std::chrono::milliseconds(50);
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || stopped_ || (called_ && Clock::now() - last_ < kInterval)) return;
    called_ = true;
    last_ = Clock::now();
    if (!look_()) stopped_ = true;
  }

 private:
  const std::function<bool()> look_;
  std::atomic<bool> stopped_{false};
  std::mutex mutex_;
  bool called_ = false;
  Clock::time_point last_{};
};

/// Pixels of a tile.
struct TileRange {
  int x0, y0, x1, y1;
  TileRange(const PathSums& sums, std::size_t tile)
      : x0(int(tile % std::size_t(sums.tilesAcross())) * kTileSize),
        y0(int(tile / std::size_t(sums.tilesAcross())) * kTileSize),
        x1(std::min(x0 + kTileSize, sums.width)),
        y1(std::min(y0 + kTileSize, sums.height)) {}
  int pixels() const { return (x1 - x0) * (y1 - y0); }
};

/// The supersampled picture's position, and its number there.
struct Position {
  int x, y;
  std::uint32_t index;
  Position(const TracerState& state, int pixel_x, int pixel_y, int position) {
    const int side = state.options.supersample;
    x = pixel_x * side + position % side;
    y = pixel_y * side + position / side;
    index = std::uint32_t(y) * std::uint32_t(state.options.width * side) + std::uint32_t(x);
  }
};

// ---- Looking --------------------------------------------------------------------------------------------------------

// Layers of a pixel as the rasteriser makes them: normal and albedo averaged over what is covered, depth and object of
// the position in the middle (frame_layers.comp.glsl).
void lookThroughPixel(TracerState& state, int x, int y) {
  const int side = state.options.supersample, positions = side * side;
  const std::size_t pixel = std::size_t(y) * std::size_t(state.options.width) + std::size_t(x);
  glm::vec3 normal(0.0f), albedo(0.0f);
  int covered = 0;
  for (int p = 0; p < positions; ++p) {
    const Position at(state, x, y, p);
    const CameraPoint point = state.integrator->look(at.x, at.y);
    if (!state.points.empty()) state.points[pixel * std::size_t(positions) + std::size_t(p)] = point;
    if (p == side / 2 * side + side / 2) {
      state.geometry.layers[1].pixels[pixel] = point.eye_depth;
      state.geometry.layers[3].ids[pixel] = std::uint32_t(point.instance + 1);
    }
    if (point.instance == kNone) continue;
    ++covered;
    normal += point.normal;
    albedo += point.albedo;
  }
  const float length = glm::length(normal);
  if (length > 0.0f) normal /= length;
  albedo /= float(std::max(covered, 1));
  for (int c = 0; c < 3; ++c) {
    state.geometry.layers[0].pixels[3 * pixel + std::size_t(c)] = normal[c];
    state.geometry.layers[2].pixels[3 * pixel + std::size_t(c)] = albedo[c];
  }
  state.alpha.pixels[pixel] = state.options.background ? 1.0f : float(covered) / float(positions);
}

// ---- Samples --------------------------------------------------------------------------------------------------------

/// What the positions of one pixel see, found when first asked for.
class PixelPoints {
 public:
  PixelPoints(const TracerState& state, int x, int y, std::size_t pixel)
      : state_(state), x_(x), y_(y), pixel_(pixel) {}
  const CameraPoint& at(int position, std::size_t& rays) {
    const std::size_t p = std::size_t(position);
    if (!state_.points.empty()) return state_.points[pixel_ * std::size_t(state_.sums.positions) + p];
    if (!(found_ >> p & 1u)) {
      const Position where(state_, x_, y_, position);
      here_[p] = state_.integrator->look(where.x, where.y);
      found_ |= 1u << p;
      ++rays;
    }
    return here_[p];
  }

 private:
  const TracerState& state_;
  const int x_, y_;
  const std::size_t pixel_;
  std::array<CameraPoint, 16> here_;
  unsigned found_ = 0;
};

/// Samples of a pixel, traced some ahead of being asked for: many of one position go faster side by side.
class PixelSamples {
 public:
  PixelSamples(const TracerState& state, int x, int y, std::size_t pixel, std::size_t& rays)
      : state_(state), x_(x), y_(y), points_(state, x, y, pixel), rays_(rays) {}
  /// Sample k of those before `until`, asked for in order; null where nothing is seen.
  const PathLight* at(std::uint32_t k, std::uint32_t until) {
    const auto positions = std::uint32_t(state_.sums.positions);
    if (k >= end_) traceOn(k, std::min(until, k + positions * kAhead));
    const std::uint32_t position = k % positions;
    return seen_ >> position & 1u ? &lights_[position * kAhead + k / positions - first_[position]] : nullptr;
  }

 private:
  static constexpr std::uint32_t kAhead = 16;  ///< of each position
  void traceOn(std::uint32_t from, std::uint32_t end) {
    const auto positions = std::uint32_t(state_.sums.positions);
    for (std::uint32_t p = 0; p < positions; ++p) {
      first_[p] = (from + positions - 1 - p) / positions;
      const std::uint32_t count = (end + positions - 1 - p) / positions - first_[p];
      if (count == 0) continue;
      const CameraPoint& point = points_.at(int(p), rays_);
      if (point.instance == kNone && !state_.options.background) continue;
      seen_ |= 1u << p;
      const Position where(state_, x_, y_, int(p));
      // Every position has a sequence of its own: a part of one pixel's would not spread evenly.
      state_.integrator->trace(point, where.x, where.y, where.index, first_[p],
                               std::span(lights_).subspan(p * kAhead, count), rays_);
    }
    end_ = end;
  }

  const TracerState& state_;
  const int x_, y_;
  PixelPoints points_;
  std::size_t& rays_;
  std::uint32_t end_ = 0, seen_ = 0;
  std::array<std::uint32_t, 16> first_;
  std::array<PathLight, 16 * kAhead> lights_;
};

void tracePixel(TracerState& state, int x, int y, std::uint32_t from, std::uint32_t until,
                std::size_t& rays) {
  PathSums& sums = state.sums;
  const std::size_t pixel = std::size_t(y) * std::size_t(sums.width) + std::size_t(x);
  const std::size_t paths = sums.paths.size();
  const auto positions = std::uint32_t(sums.positions);
  double* row = &sums.sums[pixel * paths * 3];
  double* squares = &sums.squares[pixel * 3];
  glm::dvec3 round(0.0);
  if (positions > 1) round = {sums.round[3 * pixel], sums.round[3 * pixel + 1], sums.round[3 * pixel + 2]};
  PixelSamples samples(state, x, y, pixel, rays);
  for (std::uint32_t k = from; k < until; ++k) {
    if (const PathLight* light = samples.at(k, until)) {
      for (std::size_t p = 0; p < paths; ++p) {
        const glm::dvec3 value((*light)[std::size_t(sums.paths[p])]);
        for (int c = 0; c < 3; ++c) row[3 * p + std::size_t(c)] += value[c];
        round += value;
      }
    }
    if (k % positions + 1 < positions) continue;
    for (int c = 0; c < 3; ++c) squares[c] += round[c] * round[c];
    round = glm::dvec3(0.0);
    if (!std::has_single_bit((k + 1) / positions)) continue;
    for (std::size_t c = 0; positions > 1 && c < 3; ++c) sums.round[3 * pixel + c] = 0.0;
    measureError(sums, pixel, k + 1);
  }
  for (std::size_t c = 0; positions > 1 && c < 3; ++c) sums.round[3 * pixel + c] = round[int(c)];
}

/// So many that a round takes a fifth of a second: tiles stay close to each other, and work can be followed. But no fewer than
/// go fast (PixelSamples).
std::uint32_t roundSamples(const TracerState& state) {
  if (!(state.rate > 0.0)) return 1;
  const double samples = kRoundSeconds * state.rate / double(state.sums.pixelCount());
  return std::uint32_t(std::clamp(samples, 16.0 * state.sums.positions, double(kMaxRoundSamples)));
}

}  // namespace

void lookAround(TracerState& state, const Progress& progress) {
  const ReferenceOptions& options = state.options;
  const Clock::time_point start = Clock::now();
  const std::size_t pixels = state.sums.pixelCount(), points = pixels * std::size_t(state.sums.positions);
  if (points * sizeof(CameraPoint) <= kMaxPointBytes) state.points.resize(points);
  state.alpha = Image(options.width, options.height, 1);
  state.geometry.add("normal", {"X", "Y", "Z"}, Image(options.width, options.height, 3));
  state.geometry.add("depth", {"Z"}, Image(options.width, options.height, 1), ChannelType::kFloat);
  state.geometry.add("albedo", {"R", "G", "B"}, Image(options.width, options.height, 3));
  state.geometry.addIds("object", "id", std::vector<std::uint32_t>(pixels));
  std::atomic<int> rows{0};
  Attendant attendant([&] {
    progress.report(double(rows) / double(options.height), "reference: what each pixel sees");
    return !progress.stopRequested();
  });
  withThreads(options.threads, [&] {
    tbb::parallel_for(0, options.height, [&](int y) {
      if (attendant.stopped()) return;
      for (int x = 0; x < options.width; ++x) lookThroughPixel(state, x, y);
      ++rows;
      attendant.call();
    });
  });
  if (attendant.stopped()) throw Interrupted("reference stopped before the first sample");
  state.report.rays += points;
  state.report.seconds += secondsSince(start);
}

bool advance(TracerState& state, std::uint32_t until, const Watch& watch) {
  PathSums& sums = state.sums;
  const Clock::time_point start = Clock::now();
  std::atomic<std::size_t> rays{0}, done{0};
  for (std::size_t tile = 0; tile < sums.samples.size(); ++tile) {
    done += std::size_t(TileRange(sums, tile).pixels()) * sums.samples[tile];
  }
  const std::size_t done_before = done;
  Attendant attendant([&] {
    if (watch.tell) watch.tell(double(done.load()) / double(sums.pixelCount()));
    return !(watch.should_stop && watch.should_stop());
  });
  const auto traceTile = [&](std::size_t tile, std::uint32_t target) {
    const std::uint32_t from = sums.samples[tile];
    if (from >= target || attendant.stopped()) return;
    const TileRange range(sums, tile);
    std::size_t traced = 0;
    for (int y = range.y0; y < range.y1; ++y) {
      for (int x = range.x0; x < range.x1; ++x) tracePixel(state, x, y, from, target, traced);
    }
    sums.samples[tile] = target;
    rays += traced;
    done += std::size_t(range.pixels()) * (target - from);
    attendant.call();
  };
  withThreads(state.options.threads, [&] {
    for (std::uint32_t least = sums.least(); least < until && !attendant.stopped(); least = sums.least()) {
      const std::uint32_t target = std::min(until, least + roundSamples(state));
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, sums.samples.size(), 1),
          [&](const auto& tiles) {
            for (std::size_t tile = tiles.begin(); tile != tiles.end(); ++tile) traceTile(tile, target);
          },
          tbb::simple_partitioner());
      state.rate = double(done - done_before) / std::max(1e-6, secondsSince(start));
    }
  });
  state.report.rays += rays;
  state.report.seconds += secondsSince(start);
  return sums.least() >= until;
}

}  // namespace gloam::reference
