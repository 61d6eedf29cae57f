// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Binned surface area heuristic (Wald 2007), two ways at a time; every other level is then left out (Ernst, Greiner 2008; Dammertz
// et al. 2008). Leaves hold two to four triangles. Ray against triangle: Moeller, Trumbore 1997.
#include "visibility/box_tree.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "math/box.h"

namespace gloam::visibility {

namespace {

constexpr int kBins = 16;
constexpr std::size_t kParallel = 8192;  // triangles from which both halves are built at once
constexpr double kWorn = 1.6;  // boxes so much larger than when they were built call for another tree

/// Half of the surface's.
float areaOf(const Box& box) {
  const glm::vec3 side = box.high - box.low;
  return box.empty() ? 0.0f : side.x * side.y + side.y * side.z + side.z * side.x;
}

Box boxOf(const BoxTriangle& t) {
  Box box;
  box.add(t.corner);
  box.add(t.corner + t.edge_u);
  box.add(t.corner + t.edge_v);
  return box;
}

/// Of a tree with two children a node: those of node i over n triangles are i + 1 and i + 2 n_left.
struct Pair {
  std::uint32_t first = 0, count = 0;
  std::uint32_t right = 0;  // 0: a leaf
};

struct Builder {
  std::vector<Box> boxes;
  std::vector<glm::vec3> middles;
  std::vector<std::uint32_t> order;
  std::vector<Pair> pairs;

  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count, int depth) {
    pairs[node] = {first, count, 0};
    if (count <= std::uint32_t(kLeafTriangles)) return;
    // As deep as a tree of halves would still fit.
    const bool halve = depth + int(std::bit_width(count)) >= 2 * kBoxDepth;
    const std::uint32_t left = halve ? halved(first, count) : divided(first, count);
    pairs[node].right = node + 2 * left;
    const auto buildLeft = [&] { build(node + 1, first, left, depth + 1); };
    const auto buildRight = [&] { build(node + 2 * left, first + left, count - left, depth + 1); };
    if (count >= kParallel) {
      tbb::parallel_invoke(buildLeft, buildRight);
    } else {
      buildLeft();
      buildRight();
    }
  }

  Box middlesOf(std::uint32_t first, std::uint32_t count) const {
    Box box;
    for (std::uint32_t i = first; i < first + count; ++i) box.add(middles[order[i]]);
    return box;
  }

  std::uint32_t halved(std::uint32_t first, std::uint32_t count) {
    const Box all = middlesOf(first, count);
    const glm::vec3 side = all.high - all.low;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    const auto begin = order.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count, [&](std::uint32_t a, std::uint32_t b) {
      return middles[a][axis] != middles[b][axis] ? middles[a][axis] < middles[b][axis] : a < b;
    });
    return count / 2;
  }

  /// Orders the triangles so that the first ones, whose number it returns, go left; at least two stand on each side.
  std::uint32_t divided(std::uint32_t first, std::uint32_t count) {
    const Box all = middlesOf(first, count);
    float best = std::numeric_limits<float>::infinity();
    int best_axis = 0, best_bin = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(all.high[axis] > all.low[axis])) continue;
      std::array<Box, kBins> bins;
      std::array<std::uint32_t, kBins> counts{};
      for (std::uint32_t i = first; i < first + count; ++i) {
        const int bin = binOf(all, axis, order[i]);
        bins[std::size_t(bin)].add(boxes[order[i]]);
        ++counts[std::size_t(bin)];
      }
      std::array<float, kBins> right_cost{};
      Box right;
      std::uint32_t right_count = 0;
      for (std::size_t b = kBins - 1; b > 0; --b) {
        right.add(bins[b]);
        right_count += counts[b];
        right_cost[b] = right_count < 2 ? -1.0f : areaOf(right) * float(right_count);
      }
      Box left;
      std::uint32_t left_count = 0;
      for (std::size_t b = 0; b + 1 < kBins; ++b) {
        left.add(bins[b]);
        left_count += counts[b];
        if (left_count < 2 || right_cost[b + 1] < 0.0f) continue;
        const float cost = areaOf(left) * float(left_count) + right_cost[b + 1];
        if (cost < best) best = cost, best_axis = axis, best_bin = int(b);
      }
    }
    if (!std::isfinite(best)) return halved(first, count);
    const auto begin = order.begin() + first;
    const auto middle = std::stable_partition(
        begin, begin + count, [&](std::uint32_t t) { return binOf(all, best_axis, t) <= best_bin; });
    return std::uint32_t(middle - begin);
  }

  int binOf(const Box& all, int axis, std::uint32_t triangle) const {
    const float share = (middles[triangle][axis] - all.low[axis]) / (all.high[axis] - all.low[axis]);
    return std::clamp(int(share * float(kBins)), 0, kBins - 1);
  }
};

std::uint32_t leafOf(const Pair& pair) {
  return kBoxLeaf | pair.first << 2 | (pair.count - 1);
}

/// Children of children, under their parent; those of the second kind stand in `grown`.
void addNode(std::vector<BoxNode>& nodes, const std::vector<Pair>& pairs, std::uint32_t pair) {
  const std::size_t place = nodes.size();
  nodes.emplace_back();
  std::array<std::uint32_t, 4> found{};
  int count = 0;
  if (pairs[pair].right == 0) {
    found[std::size_t(count++)] = pair;
  } else {
    for (const std::uint32_t child : {pair + 1, pairs[pair].right}) {
      if (pairs[child].right == 0) {
        found[std::size_t(count++)] = child;
      } else {
        found[std::size_t(count++)] = child + 1;
        found[std::size_t(count++)] = pairs[child].right;
      }
    }
  }
  for (int i = 0; i < 4; ++i) nodes[place].child[i] = kBoxLeaf;  // fitBoxes() leaves it empty
  for (int i = 0; i < count; ++i) {
    const std::uint32_t child = found[std::size_t(i)];
    if (pairs[child].right == 0) {
      nodes[place].child[i] = leafOf(pairs[child]);
    } else {
      nodes[place].child[i] = std::uint32_t(nodes.size());
      addNode(nodes, pairs, child);
    }
  }
  for (int i = count; i < 4; ++i) nodes[place].child[i] = 0;  // the root is nobody's child: nothing is there
}

}  // namespace

void BoxTree::build(std::span<const BoxTriangle> triangles) {
  const auto count = std::uint32_t(triangles.size());
  nodes_.clear();
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0u);
  Builder builder;
  builder.order = order_;
  for (const BoxTriangle& t : triangles) {
    builder.boxes.push_back(boxOf(t));
    builder.middles.push_back(0.5f * (builder.boxes.back().low + builder.boxes.back().high));
  }
  if (count > 0) {
    builder.pairs.resize(2 * std::size_t(count));
    builder.build(0, 0, count, 0);
    addNode(nodes_, builder.pairs, 0);
  } else {
    nodes_.emplace_back();  // four children that are not there
  }
  order_ = std::move(builder.order);
  built_area_ = 0.0;
  refit(triangles);
  built_area_ = fitBoxes();
}

bool BoxTree::refit(std::span<const BoxTriangle> triangles) {
  triangles_.resize(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) triangles_[i] = triangles[order_[i]];
  const double area = fitBoxes();
  return area <= kWorn * built_area_;
}

double BoxTree::fitBoxes() {
  double sum = 0.0;
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    BoxNode& node = nodes_[n];
    Box all;
    for (int i = 0; i < 4; ++i) {
      Box box;
      const std::uint32_t child = node.child[i];
      if ((child & kBoxLeaf) != 0) {
        const std::uint32_t first = (child & ~kBoxLeaf) >> 2;
        for (std::uint32_t t = first; t <= first + (child & 3u); ++t) box.add(boxOf(triangles_[t]));
      } else if (child != 0) {
        for (int k = 0; k < 4; ++k) box.add({nodes_[child].low[k], nodes_[child].high[k]});
      }
      node.low[i] = box.low;
      node.high[i] = box.high;
      all.add(box);
    }
    sum += double(areaOf(all));
  }
  return sum;
}

namespace {

bool meetsBox(const glm::vec3& low, const glm::vec3& high, const glm::vec3& origin, const glm::vec3& inverse,
              float t_far) {
  const glm::vec3 a = (low - origin) * inverse, b = (high - origin) * inverse;
  const glm::vec3 near = glm::min(a, b), far = glm::max(a, b);
  const float enter = std::max(std::max(near.x, near.y), std::max(near.z, 0.0f));
  const float leave = std::min(std::min(far.x, far.y), std::min(far.z, t_far));
  return enter <= leave * 1.0000005f;
}

bool meetsTriangle(const BoxTriangle& t, const glm::vec3& origin, const glm::vec3& direction, float t_far) {
  const glm::vec3 p = glm::cross(direction, t.edge_v);
  const float determinant = glm::dot(t.edge_u, p);
  if (determinant == 0.0f) return false;
  const glm::vec3 from = origin - t.corner;
  const float u = glm::dot(from, p) / determinant;
  const glm::vec3 q = glm::cross(from, t.edge_u);
  const float v = glm::dot(direction, q) / determinant;
  const float distance = glm::dot(t.edge_v, q) / determinant;
  return u >= 0.0f && v >= 0.0f && u + v <= 1.0f && distance > 0.0f && distance <= t_far;
}

}  // namespace

bool occluded(const BoxTree& tree, const glm::vec3& origin, const glm::vec3& direction, float t_far) {
  const glm::vec3 inverse =
      1.0f / glm::mix(direction, glm::vec3(1e-20f), glm::lessThan(glm::abs(direction), glm::vec3(1e-20f)));
  std::array<std::uint32_t, kBoxStack> stack{};
  int top = 0;
  std::uint32_t place = 0;
  for (;;) {
    const BoxNode& node = tree.nodes()[place];
    for (int i = 0; i < 4; ++i) {
      const std::uint32_t child = node.child[i];
      if (child == 0 || !meetsBox(node.low[i], node.high[i], origin, inverse, t_far)) continue;
      if ((child & kBoxLeaf) == 0) {
        stack[std::size_t(top++)] = child;
        continue;
      }
      const std::uint32_t first = (child & ~kBoxLeaf) >> 2;
      for (std::uint32_t t = first; t <= first + (child & 3u); ++t) {
        if (meetsTriangle(tree.triangles()[t], origin, direction, t_far)) return true;
      }
    }
    if (top == 0) return false;
    place = stack[std::size_t(--top)];
  }
}

}  // namespace gloam::visibility
