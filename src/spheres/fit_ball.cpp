// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// One ball: the centre c that minimises V(S(c, R(c)) \ O), R(c) the distance to the farthest point that the ball must hold
// (Wang et al. 2006, the inner optimisation; theirs is Powell's method, this one is Nelder and Mead's).
#include <algorithm>
#include <array>
#include <cmath>

#include "spheres/fit.h"

namespace gloam::spheres {
namespace {

constexpr int kEvaluations = 50;
constexpr float kSmallestStep = 0.005f;     // of the radius
constexpr float kBoundingShell = 0.97f;     // of the radius: points beyond it decide where the ball can go
constexpr std::uint64_t kChordLooks = 256;  // what the volume outside takes, in looks at a point
constexpr float kSlack = 1.0f + 1e-5f;  // a point that sets the radius stays inside, whatever the rounding

constexpr float kMostStrain = 2.0f;  // spread over spread at rest: beyond, the ball is useless anyway

/// Root mean square distance from the mean.
template <class At>
float spreadOf(std::size_t count, const At& at) {
  glm::vec3 mean(0.0f);
  for (std::size_t i = 0; i < count; ++i) mean += at(i);
  mean /= float(count);
  float sum = 0.0f;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 d = at(i) - mean;
    sum += glm::dot(d, d);
  }
  return std::sqrt(sum / float(count));
}

}  // namespace

std::size_t Motion::nearest(const glm::vec3& p) const {
  std::size_t best = 0;
  float least = INFINITY;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const glm::vec3 d = rest[i] - p;
    if (glm::dot(d, d) < least) least = glm::dot(d, d), best = i;
  }
  return best;
}

void FitPoints::add(const glm::vec3& p) {
  x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
  if (motion == nullptr) return;
  moved.resize(motion->moved.size());
  const std::size_t carrier = motion->nearest(p);
  for (std::size_t m = 0; m < moved.size(); ++m) {
    moved[m].push_back(motion->moved[m][carrier] + (p - motion->rest[carrier]));
  }
}

float Fit::strain(const Points& points) const {
  if (points_.moved.empty() || points.size() < 2) return 0.0f;
  const float rest = spreadOf(points.size(), [&](std::size_t i) { return points_.at(points[i]); });
  if (!(rest > 0.0f)) return 0.0f;
  float sum = 0.0f;
  for (const std::vector<glm::vec3>& moved : points_.moved) {
    const float now = spreadOf(points.size(), [&](std::size_t i) { return moved[points[i]]; });
    const float ratio = std::clamp(now / rest, 1.0f, kMostStrain);
    sum += ratio * ratio * ratio - 1.0f;
  }
  return sum / float(points_.moved.size());
}

void Fit::gather(const Points& points) {
  required_.x.clear(), required_.y.clear(), required_.z.clear();
  for (const std::uint32_t i : points) required_.add(points_.at(i));
}

float Fit::requiredRadius(const glm::vec3& c) const {
  constexpr std::size_t kLanes = 8;  // maxima apart, so that the loop becomes SIMD
  float farthest2[kLanes] = {};
  const std::size_t count = required_.count();
  const float *x = required_.x.data(), *y = required_.y.data(), *z = required_.z.data();
  const auto distance2 = [&](std::size_t i) {
    const float dx = x[i] - c.x, dy = y[i] - c.y, dz = z[i] - c.z;
    return dx * dx + dy * dy + dz * dz;
  };
  const std::size_t whole = count / kLanes * kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const float d2 = distance2(i + k);
      farthest2[k] = d2 > farthest2[k] ? d2 : farthest2[k];
    }
  }
  for (std::size_t i = whole; i < count; ++i) farthest2[0] = std::max(farthest2[0], distance2(i));
  return std::sqrt(*std::max_element(farthest2, farthest2 + kLanes)) * kSlack;
}

float Fit::price(const glm::vec3& center, float& radius) const {
  looks_ += required_.count() + kChordLooks;
  radius = requiredRadius(center);
  return occupancy_.outsideVolume(center, radius);
}

Ball Fit::tightest(glm::vec3 center, float step, float& outside) const {
  struct Corner {
    glm::vec3 at;
    float radius, price;
  };
  int evaluations = 0;
  const auto evaluate = [&](const glm::vec3& at) {
    ++evaluations;
    Corner corner{at, 0.0f, 0.0f};
    corner.price = price(at, corner.radius);
    return corner;
  };
  const float s = 0.57735027f * step;  // a regular simplex about the start
  std::array<Corner, 4> simplex{
      evaluate(center + glm::vec3(s, s, s)), evaluate(center + glm::vec3(s, -s, -s)),
      evaluate(center + glm::vec3(-s, s, -s)), evaluate(center + glm::vec3(-s, -s, s))};
  const Corner start = evaluate(center);
  const auto cheaper = [](const Corner& a, const Corner& b) { return a.price < b.price; };
  std::sort(simplex.begin(), simplex.end(), cheaper);
  if (start.price < simplex[0].price) {
    simplex[3] = start;
    std::sort(simplex.begin(), simplex.end(), cheaper);
  }
  while (evaluations < kEvaluations) {
    const glm::vec3 spread = simplex[3].at - simplex[0].at;
    if (glm::dot(spread, spread) < kSmallestStep * kSmallestStep * start.radius * start.radius) break;
    const glm::vec3 base = (simplex[0].at + simplex[1].at + simplex[2].at) / 3.0f;
    const Corner mirrored = evaluate(2.0f * base - simplex[3].at);
    if (mirrored.price < simplex[0].price) {
      const Corner beyond = evaluate(3.0f * base - 2.0f * simplex[3].at);
      simplex[3] = beyond.price < mirrored.price ? beyond : mirrored;
    } else if (mirrored.price < simplex[2].price) {
      simplex[3] = mirrored;
    } else {
      const bool outward = mirrored.price < simplex[3].price;
      const Corner nearer = evaluate(0.5f * (base + (outward ? mirrored.at : simplex[3].at)));
      if (nearer.price < std::min(mirrored.price, simplex[3].price)) {
        simplex[3] = nearer;
      } else {
        for (int i = 1; i < 4; ++i)
          simplex[std::size_t(i)] = evaluate(0.5f * (simplex[0].at + simplex[std::size_t(i)].at));
      }
    }
    std::sort(simplex.begin(), simplex.end(), cheaper);
  }
  outside = simplex[0].price;
  return {simplex[0].at, simplex[0].radius};
}

void Fit::countCover(const Ball& ball, int by) {
  const float r2 = ball.radius * ball.radius;
  const std::size_t count = points_.count();
  looks_ += count;
  const float *x = points_.x.data(), *y = points_.y.data(), *z = points_.z.data();
  std::uint16_t* cover = now_.cover.data();
  const glm::vec3 c = ball.center;
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = x[i] - c.x, dy = y[i] - c.y, dz = z[i] - c.z;
    cover[i] = std::uint16_t(cover[i] + (dx * dx + dy * dy + dz * dz <= r2 ? by : 0));
  }
}

Fit::Points Fit::ownedBy(std::size_t ball) const {
  const glm::vec3 c = now_.balls[ball].center;
  const float r2 = now_.balls[ball].radius * now_.balls[ball].radius;
  Points owned;
  looks_ += points_.count();
  for (std::size_t i = 0; i < points_.count(); ++i) {
    if (now_.cover[i] != 1) continue;
    const float dx = points_.x[i] - c.x, dy = points_.y[i] - c.y, dz = points_.z[i] - c.z;
    if (dx * dx + dy * dy + dz * dz <= r2) owned.push_back(std::uint32_t(i));
  }
  return owned;
}

/// A name for the set of points near the ball's surface: while they stay the same, so does the best ball.
std::uint64_t Fit::boundingPoints(const Ball& ball, const Points& owned) const {
  const float shell2 = ball.radius * ball.radius * kBoundingShell * kBoundingShell;
  std::uint64_t name = 1;
  for (const std::uint32_t i : owned) {
    const glm::vec3 d = points_.at(i) - ball.center;
    if (glm::dot(d, d) >= shell2) name = (name ^ i) * 0x9e3779b97f4a7c15u;
  }
  return name | 1u;
}

void Fit::replace(std::size_t ball, const Ball& with, float outside) {
  if (now_.balls[ball].radius > 0.0f) countCover(now_.balls[ball], -1);
  now_.balls[ball] = with;
  now_.outside[ball] = outside;
  now_.bound[ball] = 0;
  if (with.radius > 0.0f) countCover(with, 1);
}

void Fit::replaceWithBest(std::size_t ball, const Points& required) {
  if (required.empty()) {
    replace(ball, {now_.balls[ball].center, 0.0f}, 0.0f);
    return;
  }
  gather(required);
  const Ball old = now_.balls[ball];
  glm::vec3 middle(0.0f);
  for (const std::uint32_t i : required) middle += points_.at(i);
  middle /= float(required.size());
  // From where it was; from the middle of its points where that is cheaper (it may have been somewhere else altogether).
  float at_old = 0.0f, at_middle = 0.0f, outside = 0.0f;
  const float price_old = old.radius > 0.0f ? price(old.center, at_old) : INFINITY;
  const float price_middle = price(middle, at_middle);
  const bool from_old = price_old <= price_middle;
  const Ball found = tightest(from_old ? old.center : middle,
                              (from_old ? 0.1f : 0.2f) * (from_old ? at_old : at_middle), outside);
  outside += strain(required) * ballVolume(found.radius);
  replace(ball, found, outside);
}

void Fit::refit(std::size_t ball, const Points& more) {
  stopIfAsked();
  Points required = ownedBy(ball);
  for (const std::uint32_t i : more) {
    if (now_.cover[i] == 0) required.push_back(i);
  }
  if (!more.empty() || required.empty()) {
    replaceWithBest(ball, required);
    return;
  }
  const Ball old = now_.balls[ball];
  const float outside = now_.outside[ball];
  const std::uint64_t bound = boundingPoints(old, required);
  if (now_.bound[ball] == bound) return;
  replaceWithBest(ball, required);
  if (now_.outside[ball] >= outside) {  // never for the worse
    replace(ball, old, outside);
    now_.bound[ball] = bound;
  } else {
    now_.bound[ball] = boundingPoints(now_.balls[ball], required);
  }
}

}  // namespace gloam::spheres
