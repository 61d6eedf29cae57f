// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Ren, Wang, Snyder, Tong, Liu, Sun, Guo 2006, "Real-time soft shadows in dynamic scenes using spherical harmonic exponentiation":
// hierarchical sphere sets and ratio vectors. Differs from the paper: a ratio vector has one factor a band, since both sides are
// nearly zonal about one direction and single coefficients pass through 0; nodes are blended where they give way, so that the sum
// is continuous within a cluster as well as nearly so between clusters.
#include "spheres/cluster_log.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace gloam::spheres {
namespace {

float sineOf(const Sphere& sphere, float distance) {
  return distance > sphere.radius ? sphere.radius / distance : 1.0f;
}

void addScaled(sh::Sh& sum, const sh::Sh& term, float scale, const RatioVector* ratios) {
  int i = 0;
  for (int l = 0; l < sum.order; ++l) {
    const float factor = ratios != nullptr ? scale * (*ratios)[std::size_t(l)] : scale;
    for (int m = -l; m <= l; ++m, ++i) sum[i] += factor * term[i];
  }
}

RatioVector ratioOf(const sh::Sh& leaves, const sh::Sh& bound) {
  RatioVector ratios{};
  int i = 0;
  for (int l = 0; l < bound.order; ++l) {
    float both = 0.0f, own = 0.0f;
    for (int m = -l; m <= l; ++m, ++i) both += leaves[i] * bound[i], own += bound[i] * bound[i];
    ratios[std::size_t(l)] = own > 0.0f ? both / own : 0.0f;
  }
  return ratios;
}

/// Leaves below a node, by index.
std::vector<Sphere> leavesOf(const SphereTree& tree, std::span<const Sphere> spheres, int node) {
  std::vector<Sphere> leaves;
  std::vector<int> open{node};
  while (!open.empty()) {
    const SphereTree::Node& at = tree.nodes[std::size_t(open.back())];
    open.pop_back();
    if (at.children == 0) leaves.push_back(spheres[std::size_t(at.sphere)]);
    for (int c = 0; c < at.children; ++c) open.push_back(at.first_child + c);
  }
  return leaves;
}

}  // namespace

sh::Sh logOfSphere(const sh::LogBlockerTable& table, const Sphere& sphere, const glm::vec3& receiver) {
  const glm::vec3 to = sphere.center - receiver;
  const float distance = glm::length(to);
  const glm::vec3 direction = distance > 0.0f ? to / distance : glm::vec3(0.0f, 0.0f, 1.0f);
  return sh::rotateZonal(table.at(sineOf(sphere, distance)), direction);
}

sh::Sh logOfSpheres(const sh::LogBlockerTable& table, std::span<const Sphere> spheres,
                    const glm::vec3& receiver) {
  sh::Sh sum(table.order);
  for (const Sphere& sphere : spheres) addScaled(sum, logOfSphere(table, sphere, receiver), 1.0f, nullptr);
  return sum;
}

ClusterLog::ClusterLog(const SphereTree& tree, std::span<const Sphere> spheres, const Sphere& receivers,
                       const sh::LogBlockerTable& table, const CutLimits& limits)
    : tree_(tree), spheres_(spheres), table_(table), limits_(limits), ratio_of_(tree.nodes.size(), kNone) {
  if (!(limits.sin_coarse > 0.0f && limits.sin_coarse < limits.sin_fine && limits.sin_fine <= 1.0f)) {
    throw Error("cut of spheres", fmt::format("limits {} and {}; expected 0 < coarse < fine <= 1",
                                              limits.sin_coarse, limits.sin_fine));
  }
  const auto leaves = std::ranges::count_if(tree.nodes, [](const auto& node) { return node.children == 0; });
  if (std::size_t(leaves) != spheres.size())
    throw Error("sphere tree", fmt::format("{} spheres; expected {}", spheres.size(), leaves));
  std::vector<int> open;
  if (!tree.nodes.empty()) open.push_back(0);
  while (!open.empty()) {
    const int n = open.back();
    open.pop_back();
    const SphereTree::Node& node = tree.nodes[std::size_t(n)];
    if (node.children == 0) continue;
    const float distance = glm::distance(node.bound.center, receivers.center);
    const bool ever_small = sineOf(node.bound, distance + receivers.radius) < limits.sin_fine;
    const bool always_small = sineOf(node.bound, distance - receivers.radius) <= limits.sin_coarse;
    if (ever_small) {
      ratio_of_[std::size_t(n)] = int(ratios_.size());
      ratios_.push_back(ratioOf(logOfSpheres(table, leavesOf(tree, spheres, n), receivers.center),
                                logOfSphere(table, node.bound, receivers.center)));
    }
    for (int c = 0; !always_small && c < node.children; ++c) open.push_back(node.first_child + c);
  }
}

float ClusterLog::shareOf(const SphereTree::Node& node, const glm::vec3& receiver) const {
  if (node.children == 0) return 1.0f;
  const float sine = sineOf(node.bound, glm::distance(node.bound.center, receiver));
  const float t = std::clamp((limits_.sin_fine - sine) / (limits_.sin_fine - limits_.sin_coarse), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// add(node, how much of it counts).
template <typename Add>
void ClusterLog::visit(const glm::vec3& receiver, const Add& add) const {
  std::vector<std::pair<int, float>> open;
  if (!tree_.nodes.empty()) open.emplace_back(0, 1.0f);
  while (!open.empty()) {
    const auto [n, weight] = open.back();
    open.pop_back();
    const SphereTree::Node& node = tree_.nodes[std::size_t(n)];
    const float share = shareOf(node, receiver);
    if (share > 0.0f) add(n, weight * share);
    for (int c = 0; share < 1.0f && c < node.children; ++c)
      open.emplace_back(node.first_child + c, weight * (1.0f - share));
  }
}

sh::Sh ClusterLog::at(const glm::vec3& receiver) const {
  sh::Sh sum(table_.order);
  visit(receiver, [&](int n, float weight) {
    const int ratio = ratio_of_[std::size_t(n)];
    addScaled(sum, logOfSphere(table_, tree_.nodes[std::size_t(n)].bound, receiver), weight,
              ratio == kNone ? nullptr : &ratios_[std::size_t(ratio)]);
  });
  return sum;
}

std::size_t ClusterLog::termsAt(const glm::vec3& receiver) const {
  std::size_t terms = 0;
  visit(receiver, [&](int, float) { ++terms; });
  return terms;
}

}  // namespace gloam::spheres
