// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "spheres/solid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>
#include <unordered_map>

namespace gloam::spheres {
namespace {

constexpr int kCoarseCells = 48, kMostCells = 144;
constexpr float kCellsPerRadius = 8.0f;
constexpr float kSheet = 8.0f;  // squared length of a rim over area: 4 pi for a disc, 2 pi for half a ball

struct PositionHash {
  std::size_t operator()(const glm::vec3& p) const {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (int i = 0; i < 3; ++i) {
      std::uint32_t bits = 0;
      const float value = p[i] + 0.0f;  // -0 and 0 are one
      std::memcpy(&bits, &value, sizeof bits);
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return std::size_t(hash);
  }
};

/// Corners at one place become one, also where rounding has moved them a little apart.
class Welder {
 public:
  explicit Welder(std::vector<glm::vec3>& places) : places_(places) {}

  std::uint32_t operator()(const glm::vec3& p) {
    const auto [exact, fresh] = by_position_.try_emplace(p, std::uint32_t(places_.size()));
    if (fresh) {
      const std::optional<std::uint32_t> near = neighbour(p);
      exact->second = near.value_or(std::uint32_t(places_.size()));
      if (!near) {
        by_cell_.try_emplace(glm::floor(p / kCell), exact->second);
        places_.push_back(p);
      }
    }
    return exact->second;
  }

 private:
  static constexpr float kCell = 1.0f / 65536.0f, kNear = 0.25f * kCell;

  std::optional<std::uint32_t> neighbour(const glm::vec3& p) const {
    const glm::vec3 first = glm::floor(p / kCell - 0.5f);
    for (int i = 0; i < 8; ++i) {
      const auto found = by_cell_.find(first + glm::vec3(i & 1, i >> 1 & 1, i >> 2));
      if (found != by_cell_.end() && glm::distance(places_[found->second], p) <= kNear) return found->second;
    }
    return std::nullopt;
  }

  std::vector<glm::vec3>& places_;
  std::unordered_map<glm::vec3, std::uint32_t, PositionHash> by_position_, by_cell_;
};

/// Welded, without triangles that have no area.
Soup welded(const Soup& given, const glm::vec3& origin, float scale) {
  Soup soup;
  Welder weld(soup.positions);
  for (std::size_t t = 0; t < given.triangleCount(); ++t) {
    std::uint32_t corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = weld((given.corner(t, k) - origin) / scale);
    const glm::vec3 a = soup.positions[corner[0]];
    const glm::vec3 vector = glm::cross(soup.positions[corner[1]] - a, soup.positions[corner[2]] - a);
    if (glm::dot(vector, vector) > 0.0f) soup.indices.insert(soup.indices.end(), corner, corner + 3);
  }
  return soup;
}

/// Edges that have more triangles on one side than on the other, in order.
std::vector<glm::uvec2> openEdges(const Soup& soup) {
  std::unordered_map<std::uint64_t, int> balance;
  for (std::size_t i = 0; i < soup.indices.size(); ++i) {
    const std::uint32_t a = soup.indices[i], b = soup.indices[i % 3 == 2 ? i - 2 : i + 1];
    balance[(std::uint64_t(std::min(a, b)) << 32) | std::max(a, b)] += a < b ? 1 : -1;
  }
  std::vector<std::uint64_t> keys;
  for (const auto& [edge, count] : balance) {
    if (count != 0) keys.push_back(edge);
  }
  std::ranges::sort(keys);
  std::vector<glm::uvec2> edges;
  for (const std::uint64_t key : keys) edges.emplace_back(std::uint32_t(key >> 32), std::uint32_t(key));
  return edges;
}

/// Sum over rims (open edges that hang together) of their squared length, over the area.
float opennessOf(const Soup& soup, const std::vector<glm::uvec2>& open, float area) {
  std::vector<std::uint32_t> rim(soup.positions.size());  // union-find
  std::iota(rim.begin(), rim.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (rim[v] != v) v = rim[v] = rim[rim[v]];
    return v;
  };
  for (const glm::uvec2& edge : open) rim[find(edge.x)] = find(edge.y);
  std::vector<double> length(soup.positions.size(), 0.0);
  for (const glm::uvec2& edge : open) {
    length[find(edge.x)] += double(glm::distance(soup.positions[edge.x], soup.positions[edge.y]));
  }
  double sum = 0.0;
  for (const double rim_length : length) sum += rim_length * rim_length;
  return float(sum / double(area));
}

/// Axes of the surface's second moments, by Jacobi rotations; extents of the corners along them.
glm::vec3 ownExtents(const Soup& soup) {
  const std::vector<glm::vec3> points = sampleSurface(soup, 2048, 1);
  glm::dvec3 mean(0.0);
  for (const glm::vec3& p : points) mean += glm::dvec3(p) / double(points.size());
  glm::dmat3 moment(0.0), axes(1.0);
  for (const glm::vec3& p : points) moment += glm::outerProduct(glm::dvec3(p) - mean, glm::dvec3(p) - mean);
  for (int sweep = 0; sweep < 24; ++sweep) {
    const int p = sweep % 3 == 2 ? 1 : 0, q = sweep % 3 == 0 ? 1 : 2;
    if (std::abs(moment[p][q]) < 1e-30) continue;
    const double angle = 0.5 * std::atan2(2.0 * moment[p][q], moment[q][q] - moment[p][p]);
    glm::dmat3 turn(1.0);
    turn[p][p] = turn[q][q] = std::cos(angle);
    turn[q][p] = std::sin(angle), turn[p][q] = -std::sin(angle);
    moment = glm::transpose(turn) * moment * turn;
    axes = axes * turn;
  }
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (const std::uint32_t i : soup.indices) {
    const glm::vec3 along = glm::transpose(glm::mat3(axes)) * soup.positions[i];
    low = glm::min(low, along), high = glm::max(high, along);
  }
  glm::vec3 extents = high - low;
  std::sort(&extents.x, &extents.x + 3, std::greater<>());
  return extents;
}

void measure(Solid& solid) {
  double area = 0.0, volume = 0.0;
  for (std::size_t t = 0; t < solid.soup.triangleCount(); ++t) {
    const glm::dvec3 a = solid.soup.corner(t, 0), b = solid.soup.corner(t, 1), c = solid.soup.corner(t, 2);
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  solid.area = float(area);
  solid.signed_volume = float(volume);
}

}  // namespace

Solid makeSolid(const Soup& given, const std::function<bool()>& should_stop) {
  Solid solid;
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (const std::uint32_t i : given.indices) {
    low = glm::min(low, given.positions[i]), high = glm::max(high, given.positions[i]);
  }
  if (given.indices.empty()) return solid;
  const glm::vec3 size = high - low;
  solid.origin = 0.5f * low + 0.5f * high;
  solid.scale = std::max({size.x, size.y, size.z});
  if (!(solid.scale > 0.0f) || !std::isfinite(solid.scale)) {
    solid.scale = 0.0f;
    return solid;
  }
  solid.soup = welded(given, solid.origin, solid.scale);
  measure(solid);
  if (solid.degenerate()) return solid;
  solid.extents = ownExtents(solid.soup);
  const std::vector<glm::uvec2> open = openEdges(solid.soup);
  solid.closed = open.empty();
  solid.inverted = solid.closed && solid.signed_volume < 0.0f;
  solid.winding = std::make_shared<WindingTree>(solid.soup);
  const auto grid = [&](bool shell) {
    return std::make_shared<Occupancy>(solid.soup, *solid.winding, kCoarseCells, solid.closed, shell,
                                       should_stop);
  };
  solid.coarse = grid(false);
  solid.shell = solid.coarse->volume() <= 0.0f || opennessOf(solid.soup, open, solid.area) > kSheet;
  if (solid.shell) solid.coarse = grid(true);
  solid.volume = solid.coarse->volume();
  return solid;
}

std::shared_ptr<const Occupancy> makeOccupancy(const Solid& solid, int count,
                                               const std::function<bool()>& should_stop) {
  const float radius = std::cbrt(std::max(solid.volume, 1e-6f) / (4.18879f * float(count)));
  const int cells = std::clamp(int(kCellsPerRadius / radius), kCoarseCells, kMostCells);
  if (solid.shell || cells == kCoarseCells) return solid.coarse;
  return std::make_shared<Occupancy>(solid.soup, *solid.winding, cells, solid.closed, false, should_stop);
}

}  // namespace gloam::spheres
