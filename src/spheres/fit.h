// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One attempt at a sphere set: balls that together hold every given point, changed by moves that never let go of one.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "math/sampling.h"
#include "spheres/occupancy.h"

namespace gloam::spheres {

/// Places of a deforming surface, at rest and at some instants of its motion, in one unit of length.
struct Motion {
  std::vector<glm::vec3> rest;
  std::vector<std::vector<glm::vec3>> moved;  ///< [instant][place]
  std::size_t nearest(const glm::vec3& p) const;
};

/// What the balls have to hold, apart by coordinate for the inner loops.
struct FitPoints {
  std::vector<float> x, y, z;
  const Motion* motion = nullptr;  ///< set before the first point is added, or never
  std::vector<std::vector<glm::vec3>>
      moved;  ///< [instant][point]: carried by the nearest place of the motion
  std::size_t count() const { return x.size(); }
  void add(const glm::vec3& p);
  glm::vec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Not thread-safe; several fits may share occupancy and points. All that happens follows from (seed, stream).
class Fit {
 public:
  /// `should_stop` is asked every few milliseconds; then what runs throws Interrupted.
  Fit(const Occupancy& occupancy, const FitPoints& points, std::uint32_t seed, std::uint32_t stream,
      std::function<bool()> should_stop = {});

  /// Clusters of points (k-means++, Lloyd), a ball round each.
  void startFromClusters(int count);
  /// Takes balls over; points that none of them holds make the ball grow that pays least for it.
  void startFrom(const std::vector<Ball>& balls);

  /// Tries moves; one that makes the sum worse is kept while it stays within `tolerance` (relative) of the sum before, which
  /// sinks evenly from `tolerance_begin` to `tolerance_end`. Ends after `moves`, or where so many points were looked at: a bound
  /// of time that is the same on any machine.
  void run(int moves, float tolerance_begin, float tolerance_end, std::uint64_t most_looks = ~0ull);

  std::uint64_t looks() const { return looks_; }  ///< at points, so far: a measure of the work
  /// Sum of the balls' volumes outside the solid, of the best state so far; with what motion adds to them.
  double cost() const { return best_.cost; }
  /// The best state so far; balls that hold nothing by themselves have radius 0.
  const std::vector<Ball>& balls() const { return best_.balls; }

 private:
  struct State {
    std::vector<Ball> balls;
    std::vector<float> outside;        ///< of each ball, with what motion adds
    std::vector<std::uint16_t> cover;  ///< of each point: how many balls hold it
    std::vector<std::uint64_t>
        bound;  ///< of each ball: which points set its size when it was fitted last; 0: none
    double cost = 0.0;
  };
  using Points = std::vector<std::uint32_t>;

  // fit_ball.cpp: one ball at a time
  void gather(const Points& points);
  float requiredRadius(const glm::vec3& center) const;
  float price(const glm::vec3& center, float& radius) const;
  /// Share by which motion swells a ball that must hold these points: the mean over instants of (spread / spread at rest)^3,
  /// less 1. A ball that goes with one bone has none, one round both feet has much.
  float strain(const Points& points) const;
  Ball tightest(glm::vec3 center, float step, float& outside) const;
  void replace(std::size_t ball, const Ball& with, float outside);
  void replaceWithBest(std::size_t ball, const Points& required);
  void countCover(const Ball& ball, int by);
  Points ownedBy(std::size_t ball) const;
  std::uint64_t boundingPoints(const Ball& ball, const Points& owned) const;
  /// Moves and shrinks a ball to the cheapest that holds what only it holds, and `more`.
  void refit(std::size_t ball, const Points& more);

  // fit_moves.cpp
  void hand(const Points& orphans, std::size_t except);
  void settle(std::size_t ball, int rounds);
  std::vector<std::size_t> neighbours(std::size_t ball) const;
  std::size_t chooseCostly();
  std::size_t chooseIdle();
  bool relocate();
  bool repartition();
  bool shed();
  void splitBetween(const Points& points, std::size_t a, std::size_t b);
  double sum() const;
  void keepIfBest();
  void stopIfAsked() const;

  const Occupancy& occupancy_;
  const FitPoints& points_;
  sampling::Rng random_;
  State now_, best_;
  FitPoints required_;  ///< scratch: what the ball in hand must hold
  std::function<bool()> should_stop_;
  mutable std::uint64_t looks_ = 0;
};

}  // namespace gloam::spheres
