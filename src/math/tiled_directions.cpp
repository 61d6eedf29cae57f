// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Directions in tiles of 16 neighbours. Each level is a spherical Fibonacci set, cut into tiles by halving it across
// its longest extent again and again. A level's tiles are ordered so that every prefix integrates smooth functions well
// (herding: Welling 2009): of the next tiles in an order in which the halves of all cuts take turns, that one follows
// which brings the sum of the prefix's spherical harmonics, DC apart, nearest to 0.
#include <gloam/error.h>
#include <gloam/sh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "math/sampling.h"

namespace gloam::sampling {
namespace {

constexpr int kTileSize = TiledDirections::kTileSize;
constexpr std::size_t kHerdingCandidates = 256;

/// Direction in which the points spread most: power iteration on their covariance.
glm::dvec3 longestExtent(std::span<const glm::vec3> points) {
  glm::dvec3 mean(0.0);
  for (const glm::vec3& p : points) mean += glm::dvec3(p);
  mean /= static_cast<double>(points.size());
  glm::dmat3 covariance(0.0);
  for (const glm::vec3& p : points) {
    const glm::dvec3 d = glm::dvec3(p) - mean;
    covariance += glm::outerProduct(d, d);
  }
  glm::dvec3 axis(0.5, 0.6, 0.7);
  for (int i = 0; i < 32; ++i) axis = glm::normalize(covariance * axis);
  return axis;
}

/// Reorders the points, a whole number of tiles, so that tile t holds points 16 t … 16 t + 15.
void cutIntoTiles(std::span<glm::vec3> points) {
  const std::size_t tiles = points.size() / kTileSize;
  if (tiles < 2) return;
  const glm::dvec3 axis = longestExtent(points);
  const std::size_t middle = (tiles / 2) * kTileSize;
  const auto along = [&axis](const glm::vec3& p) { return glm::dot(axis, glm::dvec3(p)); };
  std::sort(points.begin(), points.end(),
            [&along](const glm::vec3& a, const glm::vec3& b) { return along(a) < along(b); });
  cutIntoTiles(points.first(middle));
  cutIntoTiles(points.subspan(middle));
}

/// Order in which the tree's leaves are visited: halves take turns at every cut.
std::vector<std::size_t> evenOrder(std::size_t first, std::size_t count) {
  if (count < 2) return std::vector<std::size_t>(count, first);
  const std::vector<std::size_t> left = evenOrder(first, count / 2);
  const std::vector<std::size_t> right = evenOrder(first + count / 2, count - count / 2);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < right.size(); ++i) {
    order.push_back(right[i]);
    if (i < left.size()) order.push_back(left[i]);
  }
  return order;
}

TiledDirections::Cone boundingCone(std::span<const glm::vec3> points) {
  glm::vec3 sum(0.0f);
  for (const glm::vec3& p : points) sum += p;
  const float length = glm::length(sum);
  if (length < 1e-3f) return {{0.0f, 0.0f, 1.0f}, -1.0f};  // spread over the whole sphere
  const glm::vec3 axis = sum / length;
  float least = 1.0f;
  for (const glm::vec3& p : points) least = std::min(least, glm::dot(axis, p));
  return {axis, std::max(-1.0f, least - 1e-6f)};
}

/// Sums of the basis over a tile's directions without the first, finer bands counting less.
using Moments = std::array<float, sh::kMaxCoefficients>;

Moments momentsOf(std::span<const glm::vec3> points) {
  sh::Sh sum(sh::kMaxOrder);
  for (const glm::vec3& p : points) sum += sh::evaluate(sh::kMaxOrder, p);
  for (int l = 0; l < sh::kMaxOrder; ++l)
    for (int m = -l; m <= l; ++m) sum[sh::index(l, m)] *= l == 0 ? 0.0f : 1.0f / static_cast<float>(l);
  return sum.c;
}

float squaredLength(const Moments& a, const Moments& b) {
  float sum = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] + b[i]) * (a[i] + b[i]);
  return sum;
}

std::vector<std::size_t> herdedOrder(std::span<const glm::vec3> points) {
  const std::vector<std::size_t> order = evenOrder(0, points.size() / kTileSize);
  struct Candidate {
    std::size_t tile;
    Moments moments;
  };
  std::vector<Candidate> candidates;
  std::vector<std::size_t> herded;
  Moments prefix{};
  for (std::size_t next = 0; herded.size() < order.size();) {
    for (; next < order.size() && candidates.size() < kHerdingCandidates; ++next)
      candidates.push_back({order[next], momentsOf(points.subspan(order[next] * kTileSize, kTileSize))});
    const auto best =
        std::min_element(candidates.begin(), candidates.end(), [&](const auto& a, const auto& b) {
          return squaredLength(prefix, a.moments) < squaredLength(prefix, b.moments);
        });
    for (std::size_t i = 0; i < prefix.size(); ++i) prefix[i] += best->moments[i];
    herded.push_back(best->tile);
    candidates.erase(best);
  }
  return herded;
}

void appendLevel(TiledDirections& set, int tiles, const glm::mat3& turn) {
  std::vector<glm::vec3> points = fibonacciSphere(tiles * kTileSize);
  for (glm::vec3& p : points) p = glm::normalize(turn * p);
  cutIntoTiles(points);
  for (const std::size_t tile : herdedOrder(points)) {
    const auto members = std::span<const glm::vec3>(points).subspan(tile * kTileSize, kTileSize);
    for (const glm::vec3& p : members) {
      set.x.push_back(p.x);
      set.y.push_back(p.y);
      set.z.push_back(p.z);
    }
    set.cones.push_back(boundingCone(members));
  }
  set.even_prefixes.push_back(set.tiles());
}

/// A rotation drawn from a seed.
glm::mat3 randomTurn(std::uint32_t seed, std::uint32_t level) {
  Rng random(seed, level);
  const float turn = 2.0f * kPi * random.next();
  const glm::mat3 about_z({std::cos(turn), std::sin(turn), 0.0f}, {-std::sin(turn), std::cos(turn), 0.0f},
                          {0.0f, 0.0f, 1.0f});
  return frame(uniformSphere(random.next2())) * about_z;
}

}  // namespace

TiledDirections makeTiledDirections(int count, int levels, std::uint32_t seed) {
  if (count < 1 || count > 1 << 24)
    throw Error("directions", "a set of " + std::to_string(count) + ", expected 1 to 16777216");
  if (levels < 1 || levels > 16)
    throw Error("directions", std::to_string(levels) + " levels, expected 1 to 16");
  const int tiles = (count + kTileSize - 1) / kTileSize;
  TiledDirections set;
  for (int level = 0; level < levels; ++level) {
    const int end = tiles >> (levels - 1 - level);  // tiles in this level and all before it
    if (end > set.tiles())
      appendLevel(set, end - set.tiles(), randomTurn(seed, static_cast<std::uint32_t>(level)));
  }
  return set;
}

}  // namespace gloam::sampling
