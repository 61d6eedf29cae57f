// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The hierarchy of Ren et al. 2006, by agglomeration instead of fitting every level anew: it can follow spheres that move.
#include <fmt/core.h>
#include <gloam/spheres.h>

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr float kSlack =
    1.0f + 4e-7f;  // a child that touches its parent's surface stays inside, whatever the rounding

struct Merge {
  Sphere bound;
  int left = kNone, right = kNone;  ///< kNone: a leaf
};

/// Binary: merges[0 … n-1] are the spheres, the last one is the root. Each group remembers its best partner.
std::vector<Merge> agglomerate(std::span<const Sphere> spheres) {
  std::vector<Merge> merges;
  for (const Sphere& sphere : spheres) merges.push_back({sphere});
  std::vector<int> live(spheres.size()), partner(spheres.size());
  std::vector<float> radius(spheres.size());
  for (std::size_t i = 0; i < live.size(); ++i) live[i] = int(i);
  const auto findPartner = [&](std::size_t i) {
    radius[i] = INFINITY;
    for (std::size_t j = 0; j < live.size(); ++j) {
      if (j == i) continue;
      const float r =
          boundingSphere(merges[std::size_t(live[i])].bound, merges[std::size_t(live[j])].bound).radius;
      if (r < radius[i]) radius[i] = r, partner[i] = live[j];
    }
  };
  for (std::size_t i = 0; i < live.size(); ++i) findPartner(i);
  while (live.size() > 1) {
    const auto a = std::size_t(std::ranges::min_element(radius) - radius.begin());
    const auto b = std::size_t(std::ranges::find(live, partner[a]) - live.begin());
    const int left = live[a], right = live[b];
    merges.push_back(
        {boundingSphere(merges[std::size_t(left)].bound, merges[std::size_t(right)].bound), left, right});
    live[a] = int(merges.size()) - 1;
    const auto drop = std::ptrdiff_t(b);
    live.erase(live.begin() + drop), partner.erase(partner.begin() + drop),
        radius.erase(radius.begin() + drop);
    for (std::size_t i = 0; i < live.size(); ++i) {
      const bool fresh = live[i] == int(merges.size()) - 1;
      if (fresh || partner[i] == left || partner[i] == right) findPartner(i);
    }
  }
  return merges;
}

}  // namespace

Sphere boundingSphere(const Sphere& a, const Sphere& b) {
  const glm::vec3 d = b.center - a.center;
  const float distance = glm::length(d);
  if (distance + b.radius <= a.radius) return a;
  if (distance + a.radius <= b.radius) return b;
  const float radius = 0.5f * (distance + a.radius + b.radius);
  return {a.center + d * ((radius - a.radius) / distance), radius * kSlack};
}

SphereTree makeSphereTree(std::span<const Sphere> spheres, int branching) {
  if (branching < 2 || branching > 16) {
    throw Error("branching", fmt::format("{}: expected 2 to 16", branching));
  }
  SphereTree tree;
  if (spheres.empty()) return tree;
  const std::vector<Merge> merges = agglomerate(spheres);
  std::vector<int> source{int(merges.size()) - 1};  // which merge a node is made of
  tree.nodes.emplace_back();
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const int from = source[n];
    const Merge& merge = merges[std::size_t(from)];
    tree.nodes[n].bound = merge.bound;
    if (merge.left == kNone) {
      tree.nodes[n].sphere = from;
      continue;
    }
    std::vector<int> children{merge.left, merge.right};
    while (int(children.size()) < branching) {  // the largest child gives way to its own
      auto largest = children.end();
      for (auto child = children.begin(); child != children.end(); ++child) {
        const Merge& candidate = merges[std::size_t(*child)];
        if (candidate.left == kNone) continue;
        if (largest == children.end() || candidate.bound.radius > merges[std::size_t(*largest)].bound.radius)
          largest = child;
      }
      if (largest == children.end()) break;
      const Merge& opened = merges[std::size_t(*largest)];
      *largest = opened.left;
      children.push_back(opened.right);
    }
    tree.nodes[n].first_child = int(tree.nodes.size());
    tree.nodes[n].children = int(children.size());
    for (const int child : children) {
      source.push_back(child);
      tree.nodes.emplace_back();
      tree.nodes.back().depth = tree.nodes[n].depth + 1;
    }
  }
  refitSphereTree(tree, spheres);
  return tree;
}

void refitSphereTree(SphereTree& tree, std::span<const Sphere> spheres) {
  const auto leaves = std::ranges::count_if(tree.nodes, [](const auto& node) { return node.children == 0; });
  if (std::size_t(leaves) != spheres.size()) {
    throw Error("sphere tree", fmt::format("{} spheres; expected {}", spheres.size(), leaves));
  }
  for (std::size_t n = tree.nodes.size(); n-- > 0;) {
    SphereTree::Node& node = tree.nodes[n];
    if (node.children == 0) {
      node.bound = spheres[std::size_t(node.sphere)];
      continue;
    }
    // Largest first: small ones are then mostly inside already.
    std::vector<Sphere> parts;
    for (int c = 0; c < node.children; ++c)
      parts.push_back(tree.nodes[std::size_t(node.first_child + c)].bound);
    std::ranges::stable_sort(parts, [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
    node.bound = parts.front();
    for (const Sphere& part : parts) node.bound = boundingSphere(node.bound, part);
  }
}

std::vector<int> cutSphereTree(const SphereTree& tree, const Sphere& receivers, float sin_limit) {
  std::vector<int> cut, open;
  if (!tree.nodes.empty()) open.push_back(0);
  while (!open.empty()) {
    const int index = open.back();
    open.pop_back();
    const SphereTree::Node& node = tree.nodes[std::size_t(index)];
    const float distance = glm::distance(node.bound.center, receivers.center) - receivers.radius;
    if (node.children == 0 || node.bound.radius <= sin_limit * distance) {
      cut.push_back(index);
      continue;
    }
    for (int c = node.children; c-- > 0;) open.push_back(node.first_child + c);
  }
  return cut;
}

}  // namespace gloam
