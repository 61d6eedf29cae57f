// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "spheres/surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace gloam::spheres {
namespace {

constexpr std::size_t kBlock = 4096;  // triangles a task
constexpr int kDeepest = 18;          // halvings of an edge
constexpr float kThin = 4.0f;         // cubes of that many pieces give one point each

struct Loose {
  glm::vec3 point;
  float excess;  ///< distance to the nearest ball
};

float excessOf(const glm::vec3& p, const std::vector<Ball>& balls) {
  float least = INFINITY;
  for (const Ball& ball : balls) {
    if (!holds(ball, p))
      least = std::min(least, glm::distance(p, ball.center) - ball.radius);
    else
      return -1.0f;
  }
  return least;
}

bool anyHolds(const std::vector<Ball>& balls, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return std::ranges::any_of(
      balls, [&](const Ball& ball) { return holds(ball, a) && holds(ball, b) && holds(ball, c); });
}

/// Calls visit(a, b, c) for the pieces, with edges of at most `finest`, that no single ball holds.
template <class Visit>
void forPieces(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, int depth, float finest,
               const std::vector<Ball>& balls, const Visit& visit) {
  if (anyHolds(balls, a, b, c)) return;
  const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
  if (longest <= finest || depth == 0) {
    visit(a, b, c);
    return;
  }
  const glm::vec3 ab = 0.5f * (a + b), bc = 0.5f * (b + c), ca = 0.5f * (c + a);
  forPieces(a, ab, ca, depth - 1, finest, balls, visit);
  forPieces(ab, b, bc, depth - 1, finest, balls, visit);
  forPieces(ca, bc, c, depth - 1, finest, balls, visit);
  forPieces(ab, bc, ca, depth - 1, finest, balls, visit);
}

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

std::vector<glm::vec3> uncoveredPoints(const Soup& soup, const std::vector<Ball>& balls, float finest) {
  const std::size_t blocks = (soup.triangleCount() + kBlock - 1) / kBlock;
  std::vector<std::vector<Loose>> found(blocks);
  tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
    const std::size_t end = std::min((block + 1) * kBlock, soup.triangleCount());
    for (std::size_t t = block * kBlock; t < end; ++t) {
      forPieces(soup.corner(t, 0), soup.corner(t, 1), soup.corner(t, 2), kDeepest, finest, balls,
                [&](const auto&... corners) {
                  for (const glm::vec3& p : {corners...}) {
                    const float excess = excessOf(p, balls);
                    if (excess > 0.0f) found[block].push_back({p, excess});
                  }
                });
    }
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

void growOver(const Soup& soup, std::vector<Ball>& balls, float finest) {
  const auto growOverPiece = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    Ball* cheapest = nullptr;
    float least = INFINITY, radius = 0.0f;
    for (Ball& ball : balls) {
      const float farthest = std::max(
          {glm::distance(a, ball.center), glm::distance(b, ball.center), glm::distance(c, ball.center)});
      const float growth = ballVolume(farthest) - ballVolume(ball.radius);
      if (growth < least) least = growth, cheapest = &ball, radius = farthest;
    }
    if (cheapest != nullptr && least > 0.0f) cheapest->radius = radius * (1.0f + 1e-5f);
  };
  for (std::size_t t = 0; t < soup.triangleCount(); ++t) {
    forPieces(soup.corner(t, 0), soup.corner(t, 1), soup.corner(t, 2), kDeepest, finest, balls,
              growOverPiece);
  }
}

}  // namespace gloam::spheres
