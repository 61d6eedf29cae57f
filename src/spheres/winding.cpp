// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Jacobson, Kavan, Sorkine-Hornung 2013 (generalised winding numbers), w(p) = 1/4pi sum of signed solid angles; Barill et al.
// 2018: a far cluster of triangles is the dipole sum(a n) . (c - p) / 4pi |c - p|^3. First order only: an inside test asks
// for no more.
#include "spheres/winding.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace gloam::spheres {
namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr float kOpening = 2.2f;  // clusters nearer than this many radii are opened
constexpr float kInverseFourPi = float(0.25 * std::numbers::inv_pi);

struct SolidAngle {
  float above, below;  ///< tan of half of it
};

SolidAngle halfTangent(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& point) {
  const glm::vec3 u = a - point, v = b - point, w = c - point;
  const float lu = glm::length(u), lv = glm::length(v), lw = glm::length(w);
  return {glm::dot(u, glm::cross(v, w)),
          lu * lv * lw + glm::dot(u, v) * lw + glm::dot(v, w) * lu + glm::dot(w, u) * lv};
}

/// Minimax polynomial, within 2e-5: thousands are summed for one bit.
float quickAtan2(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float greater = std::max(ax, ay);
  if (greater == 0.0f) return 0.0f;
  const float a = std::min(ax, ay) / greater, s = a * a;
  float angle =
      ((((-0.0117212f * s + 0.05265332f) * s - 0.11643287f) * s + 0.19354346f) * s - 0.33262347f) * s * a +
      0.99997726f * a;
  if (ay > ax) angle = float(0.5 * std::numbers::pi) - angle;
  if (x < 0.0f) angle = float(std::numbers::pi) - angle;
  return y < 0.0f ? -angle : angle;
}

}  // namespace

float triangleSolidAngle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& point) {
  const SolidAngle angle = halfTangent(a, b, c, point);
  return angle.above == 0.0f ? 0.0f : 2.0f * std::atan2(angle.above, angle.below);
}

WindingTree::WindingTree(const Soup& soup) {
  const std::size_t count = soup.triangleCount();
  std::vector<glm::vec3> centers(count);
  for (std::size_t t = 0; t < count; ++t) {
    centers[t] = (soup.corner(t, 0) + soup.corner(t, 1) + soup.corner(t, 2)) / 3.0f;
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  triangles_.reserve(count);
  nodes_.reserve(2 * count / kLeafSize + 2);
  if (count > 0) build(soup, order, 0, std::uint32_t(count), centers);
}

// Depth first: the left child follows its parent, and the triangles below a node stand in one run.
std::uint32_t WindingTree::build(const Soup& soup, std::vector<std::uint32_t>& order, std::uint32_t begin,
                                 std::uint32_t end, const std::vector<glm::vec3>& centers) {
  const auto index = std::uint32_t(nodes_.size());
  nodes_.emplace_back();
  if (end - begin <= kLeafSize) {
    for (std::uint32_t i = begin; i < end; ++i) {
      triangles_.push_back({soup.corner(order[i], 0), soup.corner(order[i], 1), soup.corner(order[i], 2)});
    }
    nodes_[index].first = begin;
    nodes_[index].count = end - begin;
  } else {
    glm::vec3 low = centers[order[begin]], high = low;
    for (std::uint32_t i = begin; i < end; ++i) {
      low = glm::min(low, centers[order[i]]), high = glm::max(high, centers[order[i]]);
    }
    const glm::vec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       return centers[a][axis] != centers[b][axis] ? centers[a][axis] < centers[b][axis]
                                                                   : a < b;
                     });
    build(soup, order, begin, middle, centers);
    nodes_[index].first = build(soup, order, middle, end, centers);
  }
  summarise(nodes_[index], begin, end);
  return index;
}

void WindingTree::summarise(Node& node, std::uint32_t begin, std::uint32_t end) const {
  glm::dvec3 weighted(0.0), area_vector(0.0), middle(0.0);
  double area = 0.0;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Triangle& t = triangles_[i];
    const glm::dvec3 vector = 0.5 * glm::cross(glm::dvec3(t.b - t.a), glm::dvec3(t.c - t.a));
    const glm::dvec3 center = (glm::dvec3(t.a) + glm::dvec3(t.b) + glm::dvec3(t.c)) / 3.0;
    const double size = glm::length(vector);
    area += size;
    area_vector += vector;
    weighted += size * center;
    middle += center;
  }
  node.center = glm::vec3(area > 0.0 ? weighted / area : middle / double(end - begin));
  node.area_vector = glm::vec3(area_vector);
  float radius2 = 0.0f;
  for (std::uint32_t i = begin; i < end; ++i) {
    for (const glm::vec3& p : {triangles_[i].a, triangles_[i].b, triangles_[i].c}) {
      const glm::vec3 d = p - node.center;
      radius2 = std::max(radius2, glm::dot(d, d));
    }
  }
  node.radius2 = kOpening * kOpening * radius2;
}

float WindingTree::at(const glm::vec3& point) const {
  if (nodes_.empty()) return 0.0f;
  float sum = 0.0f;
  std::uint32_t stack[64];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t index = stack[--depth];
    const Node& node = nodes_[index];
    const glm::vec3 d = node.center - point;
    const float distance2 = glm::dot(d, d);
    if (distance2 > node.radius2 && distance2 > 0.0f) {
      sum += glm::dot(node.area_vector, d) / (distance2 * std::sqrt(distance2));
    } else if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const SolidAngle angle = halfTangent(triangles_[i].a, triangles_[i].b, triangles_[i].c, point);
        if (angle.above != 0.0f) sum += 2.0f * quickAtan2(angle.above, angle.below);
      }
    } else {
      stack[depth++] = node.first;
      stack[depth++] = index + 1;
    }
  }
  return sum * kInverseFourPi;
}

}  // namespace gloam::spheres
