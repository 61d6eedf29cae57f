// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Wang et al. 2006 alternate two steps, assigning points and fitting balls, and teleport a ball when stuck. Here every ball
// is bound only to the points that no other holds, so fitting one after another cannot raise the sum; teleporting,
// dividing a pair anew and shedding a cap are random moves, kept while they stay near the best (threshold accepting,
// Dueck and Scheuer 1990).
#include <gloam/error.h>

#include <algorithm>
#include <cmath>

#include "spheres/fit.h"

namespace gloam::spheres {
namespace {

constexpr int kLloydRounds = 8;
constexpr int kTournament = 3;

}  // namespace

Fit::Fit(const Occupancy& occupancy, const FitPoints& points, std::uint32_t seed, std::uint32_t stream,
         std::function<bool()> should_stop)
    : occupancy_(occupancy), points_(points), random_(seed, stream), should_stop_(std::move(should_stop)) {
  now_.cover.assign(points.count(), 0);
}

void Fit::stopIfAsked() const {
  if (should_stop_ && should_stop_()) throw Interrupted("interrupted: no sphere set");
}

// ---- Beginnings --------------------------------------------------------------------------------------------------------

void Fit::startFromClusters(int wanted) {
  const std::size_t count = points_.count();
  std::vector<glm::vec3> centers{points_.at(random_.below(std::uint32_t(count)))};
  std::vector<float> nearest(count, INFINITY);
  std::vector<std::uint32_t> cluster(count, 0);
  while (int(centers.size()) < wanted) {
    stopIfAsked();
    double total = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec3 d = points_.at(i) - centers.back();
      nearest[i] = std::min(nearest[i], glm::dot(d, d));
      total += double(nearest[i]);
    }
    double pick = double(random_.next()) * total;
    std::size_t chosen = 0;
    while (chosen + 1 < count && (pick -= double(nearest[chosen])) > 0.0) ++chosen;
    centers.push_back(points_.at(chosen));
  }
  for (int round = 0; round < kLloydRounds; ++round) {
    std::vector<glm::vec3> sums(centers.size(), glm::vec3(0.0f));
    std::vector<int> members(centers.size(), 0);
    for (std::size_t i = 0; i < count; ++i) {
      if (i % 1024 == 0) stopIfAsked();
      float least = INFINITY;
      for (std::size_t c = 0; c < centers.size(); ++c) {
        const glm::vec3 d = points_.at(i) - centers[c];
        if (glm::dot(d, d) < least) least = glm::dot(d, d), cluster[i] = std::uint32_t(c);
      }
      sums[cluster[i]] += points_.at(i), ++members[cluster[i]];
    }
    for (std::size_t c = 0; c < centers.size(); ++c) {
      if (members[c] > 0) centers[c] = sums[c] / float(members[c]);
    }
  }
  std::vector<Points> clusters(centers.size());
  for (std::size_t i = 0; i < count; ++i) clusters[cluster[i]].push_back(std::uint32_t(i));
  now_.balls.assign(centers.size(), {});
  now_.outside.assign(centers.size(), 0.0f);
  now_.bound.assign(centers.size(), 0);
  for (std::size_t c = 0; c < centers.size(); ++c) {
    stopIfAsked();
    now_.balls[c].center = centers[c];
    replaceWithBest(c, clusters[c]);
  }
  for (std::size_t c = 0; c < centers.size(); ++c) refit(c, {});
  best_.cost = INFINITY;
  keepIfBest();
}

void Fit::startFrom(const std::vector<Ball>& balls) {
  now_.balls = balls;
  now_.outside.resize(balls.size());
  now_.bound.assign(balls.size(), 0);
  std::fill(now_.cover.begin(), now_.cover.end(), std::uint16_t(0));
  for (std::size_t b = 0; b < balls.size(); ++b) {
    now_.outside[b] = occupancy_.outsideVolume(balls[b].center, balls[b].radius);
    if (balls[b].radius > 0.0f) countCover(balls[b], 1);
  }
  for (std::size_t b = 0; b < balls.size() && !points_.moved.empty(); ++b) {
    stopIfAsked();
    now_.outside[b] += strain(ownedBy(b)) * ballVolume(balls[b].radius);
  }
  Points orphans;
  for (std::size_t i = 0; i < points_.count(); ++i) {
    if (now_.cover[i] == 0) orphans.push_back(std::uint32_t(i));
  }
  hand(orphans, balls.size());
  best_.cost = INFINITY;
  keepIfBest();
}

// ---- Moves -------------------------------------------------------------------------------------------------------------

double Fit::sum() const {
  double total = 0.0;
  for (const float outside : now_.outside) total += double(outside);
  return total;
}

void Fit::keepIfBest() {
  now_.cost = sum();
  if (now_.cost < best_.cost) best_ = now_;
}

/// Each orphan goes to the ball whose growth over the gap costs least, one ball after another.
void Fit::hand(const Points& orphans, std::size_t except) {
  std::vector<Points> taken(now_.balls.size());
  for (const std::uint32_t i : orphans) {
    looks_ += now_.balls.size();
    float least = INFINITY;
    std::size_t to = 0;
    for (std::size_t b = 0; b < now_.balls.size(); ++b) {
      if (b == except || (now_.balls[b].radius <= 0.0f && now_.balls.size() > 1)) continue;
      const float distance = glm::distance(points_.at(i), now_.balls[b].center);
      const float growth = ballVolume(distance) - ballVolume(now_.balls[b].radius);
      if (growth < least) least = growth, to = b;
    }
    if (least == INFINITY) to = except == 0 ? now_.balls.size() - 1 : 0;
    taken[to].push_back(i);
  }
  for (std::size_t b = 0; b < taken.size(); ++b) {
    if (std::ranges::any_of(taken[b], [&](std::uint32_t i) { return now_.cover[i] == 0; }))
      refit(b, taken[b]);
  }
}

std::vector<std::size_t> Fit::neighbours(std::size_t ball) const {
  std::vector<std::size_t> near;
  const Ball& self = now_.balls[ball];
  for (std::size_t b = 0; b < now_.balls.size(); ++b) {
    const Ball& other = now_.balls[b];
    const float reach = self.radius + other.radius;
    const glm::vec3 d = other.center - self.center;
    if (b != ball && other.radius > 0.0f && glm::dot(d, d) < reach * reach) near.push_back(b);
  }
  return near;
}

void Fit::settle(std::size_t ball, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    refit(ball, {});
    for (const std::size_t b : neighbours(ball)) refit(b, {});
  }
}

std::size_t Fit::chooseCostly() {
  std::size_t chosen = random_.below(std::uint32_t(now_.balls.size()));
  for (int i = 1; i < kTournament; ++i) {
    const std::size_t other = random_.below(std::uint32_t(now_.balls.size()));
    if (now_.outside[other] > now_.outside[chosen]) chosen = other;
  }
  return chosen;
}

/// A ball that few points need; one that holds nothing first.
std::size_t Fit::chooseIdle() {
  const auto unused = std::ranges::find(now_.balls, 0.0f, &Ball::radius);
  if (unused != now_.balls.end()) return std::size_t(unused - now_.balls.begin());
  std::size_t chosen = 0, fewest = points_.count() + 1;
  for (int i = 0; i < kTournament; ++i) {
    const std::size_t b = random_.below(std::uint32_t(now_.balls.size()));
    const std::size_t owned = ownedBy(b).size();
    if (owned < fewest) fewest = owned, chosen = b;
  }
  return chosen;
}

/// Two balls for these points, divided by a plane through their middle: across their longest extent, or any.
void Fit::splitBetween(const Points& points, std::size_t a, std::size_t b) {
  glm::vec3 middle(0.0f);
  for (const std::uint32_t i : points) middle += points_.at(i);
  middle /= float(points.size());
  glm::vec3 normal = sampling::uniformSphere(random_.next2());
  if (random_.next() < 0.6f) {  // towards the longest axis: power iteration from a random start
    for (int step = 0; step < 3; ++step) {
      glm::vec3 next(0.0f);
      for (const std::uint32_t i : points) {
        const glm::vec3 d = points_.at(i) - middle;
        next += d * glm::dot(d, normal);
      }
      const float length = glm::length(next);
      if (length > 0.0f) normal = next / length;
    }
  }
  Points halves[2];
  for (const std::uint32_t i : points)
    halves[glm::dot(points_.at(i) - middle, normal) > 0.0f ? 1 : 0].push_back(i);
  replace(a, {now_.balls[a].center, 0.0f}, 0.0f);
  replace(b, {now_.balls[b].center, 0.0f}, 0.0f);
  replaceWithBest(a, halves[0]);
  replaceWithBest(b, halves[1]);
}

/// Teleportation: a ball that little needs leaves, its points go to its neighbours, and it halves a costly one.
bool Fit::relocate() {
  if (now_.balls.size() < 3) return false;
  const std::size_t idle = chooseIdle(), costly = chooseCostly();
  if (idle == costly) return false;
  const Points orphans = ownedBy(idle);
  const std::vector<std::size_t> left_behind = neighbours(idle);
  replace(idle, {now_.balls[idle].center, 0.0f}, 0.0f);
  hand(orphans, idle);
  const Points points = ownedBy(costly);
  if (points.size() < 2) return false;
  splitBetween(points, costly, idle);
  settle(costly, 1);
  for (const std::size_t b : left_behind) refit(b, {});
  return true;
}

/// What only two neighbours hold is divided between them anew.
bool Fit::repartition() {
  const std::size_t a = chooseCostly();
  const std::vector<std::size_t> near = neighbours(a);
  if (near.empty()) return false;
  const std::size_t b = near[random_.below(std::uint32_t(near.size()))];
  countCover(now_.balls[a],
             -1);  // what b holds alone once a is gone is theirs together, and so is what a held alone
  countCover(now_.balls[b], -1);
  Points theirs;
  for (std::size_t i = 0; i < points_.count(); ++i) {
    if (now_.cover[i] == 0) theirs.push_back(std::uint32_t(i));
  }
  countCover(now_.balls[a], 1);
  countCover(now_.balls[b], 1);
  if (theirs.size() < 2) return false;
  splitBetween(theirs, a, b);
  settle(a, 1);
  settle(b, 1);
  return true;
}

/// A cap of what a ball holds alone goes to its neighbours.
bool Fit::shed() {
  const std::size_t ball = chooseCostly();
  if (neighbours(ball).empty()) return false;
  Points owned = ownedBy(ball);
  if (owned.size() < 2) return false;
  const glm::vec3 way = sampling::uniformSphere(random_.next2());
  const float share = 0.02f + 0.4f * random_.next() * random_.next();
  const std::size_t kept = std::min(owned.size() - 1, std::size_t(float(owned.size()) * (1.0f - share)));
  std::nth_element(owned.begin(), owned.begin() + std::ptrdiff_t(kept), owned.end(),
                   [&](std::uint32_t i, std::uint32_t j) {
                     const float a = glm::dot(points_.at(i), way), b = glm::dot(points_.at(j), way);
                     return a != b ? a < b : i < j;
                   });
  const Points orphans(owned.begin() + std::ptrdiff_t(kept), owned.end());
  owned.resize(kept);
  replaceWithBest(ball, owned);
  hand(orphans, ball);
  settle(ball, 1);
  return true;
}

void Fit::run(int moves, float tolerance_begin, float tolerance_end, std::uint64_t most_looks) {
  if (now_.balls.size() < 2) {
    refit(0, {});
    keepIfBest();
    return;
  }
  const std::uint64_t before_all = looks_;
  for (int move = 0; move < moves && looks_ - before_all < most_looks; ++move) {
    stopIfAsked();
    const float sinks = tolerance_end - tolerance_begin;
    const auto by_looks = float(double(looks_ - before_all) / double(most_looks));
    const float tolerance = tolerance_begin + std::min(sinks * float(move) / float(moves), sinks * by_looks);
    const State before = now_;
    const float kind = random_.next();
    const bool changed = kind < 0.25f ? relocate() : (kind < 0.6f ? repartition() : shed());
    now_.cost = sum();
    if (!changed || now_.cost > best_.cost * (1.0 + double(tolerance))) {
      now_ = before;
    } else {
      keepIfBest();
    }
  }
}

}  // namespace gloam::spheres
