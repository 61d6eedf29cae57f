// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "renderer/flat_groups.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>

namespace gloam {

namespace {

constexpr float kUnmet = 0.05f, kUnlit = 0.2f;  // things move; lamps shine, too
constexpr std::size_t kFewestPoints = 8;        // of a group that was divided
// What shade apart from light weighs beside places as far apart as an even share is long.
constexpr float kShade = 2.0f;
constexpr float kLeastArea = 0.02f;  // of an even share

/// Which of six ways a direction points: 0 to 5; the axis is half of that.
int wayOf(const glm::vec3& direction) {
  const glm::vec3 size = glm::abs(direction);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return 2 * axis + (direction[axis] > 0.0f ? 1 : 0);
}

/// Where a group is best divided, and what that gains: what it sends to surfaces of the light of the sky that it gets, times how much less the
/// places of its points, and whether rays from them meet something, vary in the parts.
struct Cut {
  float gain = 0.0f, at = 0.0f;
  int axis = 0;
};

Cut bestCut(const FlatGroup& group, const glm::mat3& own_from_world, float length) {
  Cut best;
  const std::size_t count = group.points.size();
  if (count < 2 * kFewestPoints) return best;
  glm::vec3 albedo(0.0f);
  float meets = 0.0f;
  for (const FlatPoint& point : group.points) albedo += point.albedo, meets += point.area * point.meets;
  const float mean = meets / group.area;
  const float sends =
      (albedo.x + albedo.y + albedo.z) / float(count) * (mean + kUnmet) * (1.0f - mean + kUnlit);
  std::vector<std::pair<float, const FlatPoint*>> line(count);
  for (int axis = 0; axis < 3; ++axis) {
    float moment = 0.0f;
    for (std::size_t i = 0; i < count; ++i) {
      line[i] = {(own_from_world * group.points[i].place)[axis], &group.points[i]};
      moment += group.points[i].area * line[i].first;
    }
    std::ranges::sort(line, {}, &std::pair<float, const FlatPoint*>::first);
    float area = 0.0f, before = 0.0f, met = 0.0f;
    for (std::size_t i = 0; i + kFewestPoints < count; ++i) {
      const FlatPoint& point = *line[i].second;
      area += point.area, before += point.area * line[i].first, met += point.area * point.meets;
      if (i + 1 < kFewestPoints || !(line[i].first < line[i + 1].first)) continue;
      const float rest = group.area - area;
      const float apart = (before / area - (moment - before) / rest) / length;
      const float differ = met / area - (meets - met) / rest;
      const float gain = sends * area * rest / group.area * (apart * apart + kShade * differ * differ);
      if (gain > best.gain) best = {gain, 0.5f * (line[i].first + line[i + 1].first), axis};
    }
  }
  return best;
}

}  // namespace

void FlatGroup::add(const FlatPoint& point, const glm::mat3& own_from_world) {
  const glm::vec3 q = own_from_world * point.place;
  low = glm::min(low, q), high = glm::max(high, q);
  area += point.area;
  points.push_back(point);
}

std::vector<FlatGroup> groupedByCells(const std::vector<FlatPoint>& points, const glm::mat3& world_from_own,
                                      float side) {
  std::map<std::tuple<int, int, int, int>, FlatGroup> cells;
  const glm::mat3 own_from_world = glm::transpose(world_from_own);
  for (const FlatPoint& point : points) {
    const glm::vec3 q = own_from_world * point.place;
    const int way = wayOf(own_from_world * point.normal);
    const auto cell = [&](float x) { return int(std::floor(std::clamp(x / side + 0.37f, -1e6f, 1e6f))); };
    const int w = way / 2, u = (w + 1) % 3, v = (w + 2) % 3;
    FlatGroup& group = cells[{way, cell(q[u]), cell(q[v]), cell(q[w])}];
    group.axis = w;
    group.add(point, own_from_world);
  }
  std::vector<FlatGroup> groups;
  for (auto& [key, group] : cells) {
    if (group.area >= kLeastArea * side * side) groups.push_back(std::move(group));
  }
  return groups;
}

std::vector<std::vector<FlatGroup>> groupedByLight(const std::vector<std::vector<FlatPoint>>& points,
                                                   const std::vector<glm::mat3>& world_from_own, int most) {
  std::vector<std::vector<FlatGroup>> groups(points.size());
  std::vector<glm::mat3> own_from_world;
  for (const glm::mat3& axes : world_from_own) own_from_world.push_back(glm::transpose(axes));
  float area = 0.0f;
  for (const std::vector<FlatPoint>& own : points) {
    for (const FlatPoint& point : own) area += point.area;
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::map<int, FlatGroup> ways;
    for (const FlatPoint& point : points[i]) {
      const int way = wayOf(own_from_world[i] * point.normal);
      ways[way].axis = way / 2;
      ways[way].add(point, own_from_world[i]);
    }
    for (auto& [way, group] : ways) {
      if (group.area >= kLeastArea * area / float(most)) groups[i].push_back(std::move(group));
    }
    count += groups[i].size();
  }
  const float length = std::sqrt(area / float(most));
  struct Next {
    Cut cut;
    std::size_t thing, group;
    bool operator<(const Next& other) const { return cut.gain < other.cut.gain; }
  };
  std::priority_queue<Next> queue;
  const auto consider = [&](std::size_t i, std::size_t k) {
    queue.push({bestCut(groups[i][k], own_from_world[i], length), i, k});
  };
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (std::size_t k = 0; k < groups[i].size(); ++k) consider(i, k);
  }
  for (; count < std::size_t(most) && !queue.empty() && queue.top().cut.gain > 0.0f; ++count) {
    const auto [cut, i, k] = queue.top();
    queue.pop();
    FlatGroup parts[2];
    for (const FlatPoint& point : groups[i][k].points)
      parts[(own_from_world[i] * point.place)[cut.axis] < cut.at ? 0 : 1].add(point, own_from_world[i]);
    parts[0].axis = parts[1].axis = groups[i][k].axis;
    groups[i].push_back(std::move(parts[1]));
    groups[i][k] = std::move(parts[0]);
    consider(i, k);
    consider(i, groups[i].size() - 1);
  }
  return groups;
}

}  // namespace gloam
