// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The hierarchy: bounds, shape, cuts (SS-3).
#include <gloam/spheres.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "math/sampling.h"

namespace gloam {
namespace {

std::vector<Sphere> randomSpheres(std::size_t count, std::uint32_t seed) {
  sampling::Rng random(seed);
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < count; ++i) spheres.push_back({random.next3() * 10.0f, 0.1f + random.next()});
  return spheres;
}

void expectHolds(const Sphere& outer, const Sphere& inner) {
  EXPECT_LE(glm::distance(outer.center, inner.center) + inner.radius, outer.radius * 1.00001f);
}

void expectLaws(const SphereTree& tree, const std::vector<Sphere>& spheres, int branching) {
  std::vector<int> seen(spheres.size(), 0);
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const SphereTree::Node& node = tree.nodes[n];
    if (node.children == 0) {
      ++seen[std::size_t(node.sphere)];
      EXPECT_EQ(node.bound.radius, spheres[std::size_t(node.sphere)].radius);
      continue;
    }
    EXPECT_LE(node.children, branching);
    EXPECT_GE(node.children, 2);
    EXPECT_GT(node.first_child, int(n));
    for (int c = 0; c < node.children; ++c) {
      const SphereTree::Node& child = tree.nodes[std::size_t(node.first_child + c)];
      expectHolds(node.bound, child.bound);
      EXPECT_EQ(child.depth, node.depth + 1);
    }
  }
  EXPECT_EQ(std::ranges::count(seen, 1), std::ptrdiff_t(spheres.size()));
}

TEST(BoundingSphere, IsTheSmallestRoundTwo) {
  const Sphere both = boundingSphere({{0, 0, 0}, 1}, {{4, 0, 0}, 2});
  EXPECT_NEAR(both.radius, 3.5f, 1e-5f);
  EXPECT_NEAR(both.center.x, 2.5f, 1e-5f);
  EXPECT_EQ(boundingSphere({{0, 0, 0}, 3}, {{1, 0, 0}, 1}).radius, 3.0f);
  EXPECT_EQ(boundingSphere({{1, 0, 0}, 1}, {{0, 0, 0}, 3}).radius, 3.0f);
  EXPECT_EQ(boundingSphere({{1, 0, 0}, 1}, {{1, 0, 0}, 1}).radius, 1.0f);
}

TEST(SphereTree, ParentsBoundTheirChildren) {
  for (const std::size_t count : {1u, 2u, 3u, 17u, 64u}) {
    const std::vector<Sphere> spheres = randomSpheres(count, 3);
    for (const int branching : {2, 4, 8}) expectLaws(makeSphereTree(spheres, branching), spheres, branching);
  }
  EXPECT_TRUE(makeSphereTree({}).nodes.empty());
  EXPECT_THROW(makeSphereTree({}, 1), Error);
}

TEST(SphereTree, FollowsSpheresThatMove) {
  const std::vector<Sphere> before = randomSpheres(20, 5), after = randomSpheres(20, 6);
  SphereTree tree = makeSphereTree(before);
  refitSphereTree(tree, after);
  expectLaws(tree, after, 4);
  EXPECT_THROW(refitSphereTree(tree, randomSpheres(19, 1)), Error);
}

TEST(SphereTree, NeighboursMeetLowInTheTree) {
  std::vector<Sphere> spheres;  // two clouds far apart
  for (const Sphere& s : randomSpheres(8, 1)) spheres.push_back(s);
  for (const Sphere& s : randomSpheres(8, 2)) spheres.push_back({s.center + glm::vec3(1000, 0, 0), s.radius});
  const SphereTree tree = makeSphereTree(spheres, 2);
  EXPECT_LT(tree.nodes[1].bound.radius, 20.0f);
  EXPECT_LT(tree.nodes[2].bound.radius, 20.0f);
}

TEST(SphereTree, CutsStandForAllSpheresOnceWithinTheLimit) {
  const std::vector<Sphere> spheres = randomSpheres(40, 9);
  const SphereTree tree = makeSphereTree(spheres);
  std::size_t before = spheres.size() + 1;
  for (const float distance : {0.0f, 20.0f, 60.0f, 400.0f}) {
    const Sphere receivers{{5.0f + distance, 5, 5}, 1.0f};
    const std::vector<int> cut = cutSphereTree(tree, receivers, 0.15f);
    EXPECT_LE(cut.size(), before);
    before = cut.size();
    std::vector<int> covered(spheres.size(), 0), open = cut;
    while (!open.empty()) {
      const SphereTree::Node& node = tree.nodes[std::size_t(open.back())];
      open.pop_back();
      if (node.children == 0) ++covered[std::size_t(node.sphere)];
      for (int c = 0; c < node.children; ++c) open.push_back(node.first_child + c);
    }
    EXPECT_EQ(std::ranges::count(covered, 1), std::ptrdiff_t(spheres.size())) << distance;
    for (const int n : cut) {
      const SphereTree::Node& node = tree.nodes[std::size_t(n)];
      const float nearest = glm::distance(node.bound.center, receivers.center) - receivers.radius;
      EXPECT_TRUE(node.children == 0 || node.bound.radius <= 0.15f * nearest);
    }
  }
  EXPECT_EQ(before, 1u) << "from far away the root is enough";
}

}  // namespace
}  // namespace gloam
