// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Several fits run side by side, each from its own clusters; now and then the worse half goes on from the better half. What
// the leading points missed of the surface is then added, and the best fits go on with it (cutting planes).
#include "spheres/search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gloam::spheres {
namespace {

constexpr std::size_t kFits = 4;
constexpr int kEpochs = 12, kMendRounds = 16;
constexpr float kMovesPerBall = 40.0f, kMovesBase = 1000.0f;
constexpr int kPointsPerBall = 8;
// Looks at points, half a billion a second: of one fit and epoch; of all that mends. Up to 128 balls do with less.
constexpr double kMostLooks = 0.6e9, kMostMendLooks = 6e9;
constexpr float kTolerance = 1.3f,
                kMostTolerance = 0.08f;  // of the mean cost of a ball, of the sum; at first
constexpr float kSeam = 1.0f / 32.0f;  // of that: pieces across the seam of two balls that one of them takes
constexpr float kFinest = 0.004f,
                kLargestFinest = 1.0f / 400.0f;  // of the root of the area; of the solid's length

FitPoints leadingPoints(const Solid& solid, const Occupancy& occupancy, const SearchOptions& options) {
  FitPoints points;
  points.motion = options.motion;
  const int samples = std::max(options.samples, kPointsPerBall * options.count);
  for (const glm::vec3& p : sampleSurface(solid.soup, samples, options.seed)) points.add(p);
  // Inner points as well, a third as many: no hole is left within.
  const std::vector<glm::vec3> inner = occupancy.fullCells();
  const double step = std::max(1.0, double(inner.size()) / (double(samples) / 3.0));
  for (double i = 0.5 * step; i < double(inner.size()); i += step) points.add(inner[std::size_t(i)]);
  return points;
}

void stopIfAsked(const Progress& progress) {
  if (progress.stopRequested()) throw Interrupted("interrupted: no sphere set");
}

struct Fits {
  std::vector<std::vector<Ball>> balls;  ///< best first
  double looks = 0.0;                    ///< what finding them took
};

int movesOf(const SearchOptions& options) {
  if (options.count < 2) return 1;
  return std::max(1,
                  int(options.effort * (kMovesBase + kMovesPerBall * float(options.count)) / float(kEpochs)));
}

/// Epochs of moves; `fits` are balls to go on from, or empty.
Fits runFits(const Occupancy& occupancy, const FitPoints& points, const SearchOptions& options, Fits fits,
             int epochs, int moves, float tolerance, const std::function<void(double)>& report,
             const Progress& progress) {
  const bool fresh = fits.balls.empty();
  if (fresh) fits.balls.resize(kFits);
  const std::size_t count = fits.balls.size();
  std::vector<double> costs(count);
  std::vector<std::uint64_t> looks(count);
  const auto most_looks =
      std::uint64_t(kMostLooks * double(options.effort) * double(moves) / double(movesOf(options)));
  for (int epoch = 0; epoch < epochs; ++epoch) {
    stopIfAsked(progress);
    report(double(epoch) / double(epochs));
    const float begin = tolerance * (1.0f - float(epoch) / float(epochs));
    const float end = tolerance * (1.0f - float(epoch + 1) / float(epochs));
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t f) {
      Fit fit(occupancy, points, options.seed,
              std::uint32_t(f + kFits * std::size_t(epoch) + (fresh ? 0 : 1000)), progress.should_stop);
      if (fresh && epoch == 0) {
        fit.startFromClusters(options.count);
      } else {
        fit.startFrom(fits.balls[f]);
      }
      fit.run(moves, begin, end, most_looks);
      looks[f] += fit.looks();
      fits.balls[f] = fit.balls();
      costs[f] = fit.cost();
    });
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
    std::vector<std::vector<Ball>> sorted;
    for (const std::size_t f : order) sorted.push_back(std::move(fits.balls[f]));
    if (epoch > 0 && (epoch == epochs / 2 || epoch == 3 * epochs / 4)) {
      for (std::size_t f = count / 2; f < count; ++f) sorted[f] = sorted[f - count / 2];
    }
    fits.balls = std::move(sorted);
    std::sort(costs.begin(), costs.end());
  }
  fits.looks += double(std::accumulate(looks.begin(), looks.end(), std::uint64_t(0)));
  return fits;
}

}  // namespace

std::vector<Ball> findBalls(const Solid& solid, const SearchOptions& options, const Progress& progress) {
  const auto grid = makeOccupancy(solid, options.count, progress.should_stop);
  const Occupancy& occupancy = *grid;
  FitPoints points = leadingPoints(solid, occupancy, options);
  const int moves = movesOf(options);
  const auto report = [&](double from, double to) {
    return [&progress, from, to](double part) { progress.report(from + (to - from) * part, "spheres"); };
  };
  const int epochs = options.count < 2 ? 1 : kEpochs;
  Fits fits =
      runFits(occupancy, points, options, {}, epochs, moves,
              std::min(kTolerance / float(options.count), kMostTolerance), report(0.0, 0.8), progress);
  const float finest = std::min(kFinest * std::sqrt(solid.area), kLargestFinest);
  fits.looks = 0.0;
  for (int round = 0; round < kMendRounds && fits.looks < kMostMendLooks * double(options.effort); ++round) {
    std::vector<glm::vec3> missed;
    for (const std::vector<Ball>& balls : fits.balls) {
      const std::vector<glm::vec3> more = uncoveredPoints(solid.soup, balls, finest, progress.should_stop);
      missed.insert(missed.end(), more.begin(), more.end());
    }
    if (missed.empty()) break;
    for (const glm::vec3& p : missed) points.add(p);
    const double from = 0.8 + 0.2 * double(round) / kMendRounds;
    fits.balls.resize(kFits / 2);
    fits = runFits(occupancy, points, options, std::move(fits), 1, std::max(1, moves >> (3 + round / 4)),
                   0.0f, report(from, from + 0.2 / kMendRounds), progress);
  }
  std::vector<Ball> balls = std::move(fits.balls.front());
  std::erase_if(balls, [](const Ball& ball) { return ball.radius <= 0.0f; });
  growOver(solid.soup, balls, kSeam * finest, progress.should_stop);
  return balls;
}

Measured measureBalls(const Solid& solid, const std::vector<Ball>& balls, std::uint32_t seed,
                      const Progress& progress) {
  constexpr int kMostPoints = 4096, kFewestPoints = 128, kAllPoints = 1 << 19, kSurfacePoints = 200000;
  const int points = std::clamp(kAllPoints / std::max(1, int(balls.size())), kFewestPoints, kMostPoints);
  Measured measured;
  const bool exact = solid.closed && !solid.shell &&
                     std::abs(std::abs(solid.signed_volume) - solid.volume) < 0.05f * solid.volume;
  measured.volume = exact ? std::abs(double(solid.signed_volume)) : double(solid.volume);
  measured.coverage = coveredShare(sampleSurface(solid.soup, kSurfacePoints, seed + 77), balls);
  std::vector<glm::dvec2> parts(balls.size(), glm::dvec2(0.0));
  tbb::parallel_for(std::size_t(0), balls.size(), [&](std::size_t b) {
    stopIfAsked(progress);
    const Ball& ball = balls[b];
    std::vector<Ball> meet;
    std::ranges::copy_if(balls, std::back_inserter(meet), [&](const Ball& other) {
      return glm::distance(other.center, ball.center) <= 1.0001f * (other.radius + ball.radius);
    });
    double sum = 0.0, joined = 0.0;
    for (int i = 0; i < points; ++i) {
      const auto u = sampling::r2(std::uint32_t(i));
      const float depth = (float(i) + 0.5f) / float(points);
      const glm::vec3 p = ball.center + ball.radius * std::cbrt(depth) * sampling::uniformSphere(u);
      const bool inside = solid.shell ? solid.coarse->outsideVolume(p, 0.25f * solid.coarse->cell()) <= 0.0f
                                      : solid.winding->inside(p);
      if (inside) continue;
      const auto sharers = std::ranges::count_if(meet, [&](const Ball& other) { return holds(other, p); });
      sum += 1.0;
      joined += 1.0 / double(std::max<std::ptrdiff_t>(1, sharers));
    }
    parts[b] = glm::dvec2(sum, joined) / double(points) * double(ballVolume(ball.radius));
  });
  for (const glm::dvec2& part : parts) measured.outside_sum += part.x, measured.outside_union += part.y;
  return measured;
}

}  // namespace gloam::spheres
