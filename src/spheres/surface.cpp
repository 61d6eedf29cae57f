// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "spheres/surface.h"

#include <gloam/error.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <tuple>

namespace gloam::spheres {
namespace {

constexpr std::size_t kBlock = 256;  // triangles a task
constexpr int kDeepest = 18;         // halvings of an edge
constexpr float kThin = 4.0f;        // cubes of that many pieces give one point each

struct Loose {
  glm::vec3 point;
  float excess;  ///< distance to the nearest ball
};

float excessOf(const glm::vec3& p, const std::vector<Ball>& balls, std::span<const std::uint32_t> near) {
  float least = INFINITY;
  for (const std::uint32_t i : near) {
    if (holds(balls[i], p)) return -1.0f;
    least = std::min(least, glm::distance(p, balls[i].center) - balls[i].radius);
  }
  return least;
}

/// Divides pieces of a surface that no single ball holds. Of thousands of balls a small piece is the business of a few: on the way
/// down those are left out that would have to grow by more to hold any part of it than some other to hold all, and are farther from
/// any part than some other from all. Balls may grow meanwhile; that changes nothing, since those left out do not.
class Pieces {
 public:
  Pieces(const std::vector<Ball>& balls, float finest, const std::function<bool()>& should_stop)
      : balls_(balls), finest_(finest), should_stop_(should_stop) {}

  /// Calls visit(near, corners…) for the pieces, with edges of at most `finest`, of these triangles.
  template <class Visit>
  void divide(const Soup& soup, std::size_t first, std::size_t end, const Visit& visit) {
    near_.resize(balls_.size());
    std::iota(near_.begin(), near_.end(), 0u);
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (std::size_t i = 3 * first; i < 3 * end; ++i) {
      const glm::vec3& p = soup.positions[soup.indices[i]];
      low = glm::min(low, p), high = glm::max(high, p);
    }
    const std::size_t from = narrow(0, 0.5f * (low + high), 0.5f * glm::distance(low, high));
    for (std::size_t t = first; t < end; ++t) {
      if (should_stop_ && should_stop_()) throw Interrupted("interrupted: no sphere set");
      descend(soup.corner(t, 0), soup.corner(t, 1), soup.corner(t, 2), kDeepest, from, visit);
    }
  }

 private:
  /// Appends those of near_[from …] that matter to what lies in this ball; returns where they begin.
  std::size_t narrow(std::size_t from, const glm::vec3& middle, float reach) {
    const std::size_t begin = near_.size();
    float least_growth = INFINITY, least_gap = INFINITY;
    for (std::size_t i = from; i < begin; ++i) {
      const Ball& ball = balls_[near_[i]];
      const float farthest = glm::distance(middle, ball.center) + reach;
      least_growth = std::min(least_growth, ballVolume(farthest) - ballVolume(ball.radius));
      least_gap = std::min(least_gap, farthest - ball.radius);
    }
    for (std::size_t i = from; i < begin; ++i) {
      const Ball& ball = balls_[near_[i]];
      const float nearest = std::max(0.0f, glm::distance(middle, ball.center) - reach);
      if (nearest - ball.radius <= least_gap + kRounding ||
          ballVolume(nearest) - ballVolume(ball.radius) <= least_growth + kRounding) {
        near_.push_back(near_[i]);
      }
    }
    return begin;
  }

  template <class Visit>
  void descend(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, int depth, std::size_t from,
               const Visit& visit) {
    const std::span near(near_.begin() + std::ptrdiff_t(from), near_.end());
    if (std::ranges::any_of(near, [&](std::uint32_t i) {
          return holds(balls_[i], a) && holds(balls_[i], b) && holds(balls_[i], c);
        })) {
      return;
    }
    const float ab_length = glm::distance(a, b), bc_length = glm::distance(b, c),
                ca_length = glm::distance(c, a);
    if (std::max({ab_length, bc_length, ca_length}) <= finest_ || depth == 0) {
      visit(std::span<const std::uint32_t>(near), a, b, c);
      return;
    }
    const glm::vec3 middle = (a + b + c) / 3.0f;
    const float reach =
        std::max({glm::distance(a, middle), glm::distance(b, middle), glm::distance(c, middle)});
    const std::size_t inner = narrow(from, middle, reach);
    const glm::vec3 ab = 0.5f * (a + b), bc = 0.5f * (b + c), ca = 0.5f * (c + a);
    descend(a, ab, ca, depth - 1, inner, visit);
    descend(ab, b, bc, depth - 1, inner, visit);
    descend(ca, bc, c, depth - 1, inner, visit);
    descend(ab, bc, ca, depth - 1, inner, visit);
    near_.resize(inner);
  }

  static constexpr float kRounding = 1e-6f;  // of volumes in the unit cube
  const std::vector<Ball>& balls_;
  float finest_;
  const std::function<bool()>& should_stop_;
  std::vector<std::uint32_t>
      near_;  ///< a stack: what matters to a piece begins where that of the piece around it ends
};

}  // namespace

std::vector<glm::vec3> sampleSurface(const Soup& soup, int count, std::uint32_t seed) {
  std::vector<double> area_before(soup.triangleCount() + 1, 0.0);
  for (std::size_t t = 0; t < soup.triangleCount(); ++t) {
    const glm::vec3 a = soup.corner(t, 0);
    const glm::vec3 vector = glm::cross(soup.corner(t, 1) - a, soup.corner(t, 2) - a);
    area_before[t + 1] = area_before[t] + 0.5 * double(glm::length(vector));
  }
  std::vector<glm::vec3> points;
  if (area_before.back() <= 0.0) return points;
  sampling::Rng random(seed, 0x5a3f);
  for (int i = 0; i < count; ++i) {
    const double at = (double(i) + double(random.next())) / double(count) * area_before.back();
    const auto above = std::upper_bound(area_before.begin() + 1, area_before.end() - 1, at);
    const auto t = std::size_t(above - area_before.begin()) - 1;
    const glm::vec3 weights = sampling::uniformTriangle(random.next2());
    points.push_back(weights.x * soup.corner(t, 0) + weights.y * soup.corner(t, 1) +
                     weights.z * soup.corner(t, 2));
  }
  return points;
}

double coveredShare(const std::vector<glm::vec3>& points, const std::vector<Ball>& balls) {
  std::size_t covered = 0;
  for (const glm::vec3& p : points) {
    covered += std::ranges::any_of(balls, [&](const Ball& ball) { return holds(ball, p); }) ? 1 : 0;
  }
  return points.empty() ? 1.0 : double(covered) / double(points.size());
}

std::vector<glm::vec3> uncoveredPoints(const Soup& soup, const std::vector<Ball>& balls, float finest,
                                       const std::function<bool()>& should_stop) {
  const std::size_t blocks = (soup.triangleCount() + kBlock - 1) / kBlock;
  std::vector<std::vector<Loose>> found(blocks);
  tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
    const auto loosen = [&](std::span<const std::uint32_t> near, const auto&... corners) {
      for (const glm::vec3& p : {corners...}) {
        const float excess = excessOf(p, balls, near);
        if (excess > 0.0f) found[block].push_back({p, excess});
      }
    };
    const std::size_t end = std::min((block + 1) * kBlock, soup.triangleCount());
    Pieces(balls, finest, should_stop).divide(soup, block * kBlock, end, loosen);
  });
  std::map<std::tuple<int, int, int>, Loose> farthest;
  for (const std::vector<Loose>& block : found) {
    for (const Loose& loose : block) {
      const glm::ivec3 cell(glm::floor(loose.point / (kThin * finest)));
      const auto [place, fresh] = farthest.try_emplace({cell.x, cell.y, cell.z}, loose);
      if (!fresh && loose.excess > place->second.excess) place->second = loose;
    }
  }
  std::vector<glm::vec3> points;
  for (const auto& [cell, loose] : farthest) points.push_back(loose.point);
  return points;
}

void growOver(const Soup& soup, std::vector<Ball>& balls, float finest,
              const std::function<bool()>& should_stop) {
  const auto growOverPiece = [&](std::span<const std::uint32_t> near, const glm::vec3& a, const glm::vec3& b,
                                 const glm::vec3& c) {
    Ball* cheapest = nullptr;
    float least = INFINITY, radius = 0.0f;
    for (const std::uint32_t i : near) {
      Ball& ball = balls[i];
      const float farthest = std::max(
          {glm::distance(a, ball.center), glm::distance(b, ball.center), glm::distance(c, ball.center)});
      const float growth = ballVolume(farthest) - ballVolume(ball.radius);
      if (growth < least) least = growth, cheapest = &ball, radius = farthest;
    }
    if (cheapest != nullptr && least > 0.0f) cheapest->radius = radius * (1.0f + 1e-5f);
  };
  Pieces pieces(balls, finest, should_stop);
  for (std::size_t first = 0; first < soup.triangleCount(); first += kBlock) {
    pieces.divide(soup, first, std::min(first + kBlock, soup.triangleCount()), growOverPiece);
  }
}

}  // namespace gloam::spheres
