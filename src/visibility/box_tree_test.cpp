// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "visibility/box_tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"

namespace gloam::visibility {
namespace {

std::vector<BoxTriangle> scattered(int count, float size, std::uint32_t seed) {
  sampling::Rng rng(seed);
  std::vector<BoxTriangle> triangles;
  for (int i = 0; i < count; ++i)
    triangles.push_back({rng.next3(), size * (rng.next3() - 0.5f), size * (rng.next3() - 0.5f)});
  return triangles;
}

/// All triangles, one after the other, by solving for the point.
bool meetsAny(const std::vector<BoxTriangle>& triangles, const glm::vec3& origin, const glm::vec3& direction,
              float t_far) {
  for (const BoxTriangle& t : triangles) {
    const glm::dmat3 m(t.edge_u, t.edge_v, -direction);
    if (glm::determinant(m) == 0.0) continue;
    const glm::dvec3 at = glm::inverse(m) * glm::dvec3(origin - t.corner);
    if (at.x >= 0.0 && at.y >= 0.0 && at.x + at.y <= 1.0 && at.z > 0.0 && at.z <= double(t_far)) return true;
  }
  return false;
}

void expectSound(const BoxTree& tree, std::size_t triangles) {
  EXPECT_LE(tree.nodes().size(), BoxTree::mostNodes(triangles));
  std::vector<int> seen(triangles, 0);
  for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
    for (const std::uint32_t child : tree.nodes()[n].child) {
      if ((child & kBoxLeaf) == 0) {
        EXPECT_TRUE(child == 0 || child > n);
        continue;
      }
      for (std::uint32_t t = (child & ~kBoxLeaf) >> 2, left = (child & 3u) + 1; left > 0; --left, ++t)
        ++seen.at(t);
    }
  }
  for (const int times : seen) EXPECT_EQ(times, 1);
}

int depthOf(const BoxTree& tree, std::uint32_t node = 0) {
  int deepest = 0;
  for (const std::uint32_t child : tree.nodes()[node].child) {
    if ((child & kBoxLeaf) == 0 && child != 0) deepest = std::max(deepest, depthOf(tree, child));
  }
  return deepest + 1;
}

void expectTwin(const BoxTree& tree, const std::vector<BoxTriangle>& triangles, int rays) {
  sampling::Rng rng(7);
  int hits = 0, differ = 0;
  for (int i = 0; i < rays; ++i) {
    const glm::vec3 origin = rng.next3(), direction = sampling::uniformSphere(rng.next2());
    const bool want = meetsAny(triangles, origin, direction, 0.4f);
    hits += want ? 1 : 0;
    differ += occluded(tree, origin, direction, 0.4f) != want ? 1 : 0;
  }
  EXPECT_LE(differ, rays / 2000);  // edges that a ray grazes
  EXPECT_GT(hits, rays / 40);
  EXPECT_LT(hits, rays);
}

TEST(BoxTree, MeetsWhatStandsInTheWay) {
  for (const int count : {1, 2, 3, 4, 5, 6, 9, 100, 3000}) {
    const auto triangles = scattered(count, count < 100 ? 2.0f : 0.2f, std::uint32_t(count));
    BoxTree tree;
    tree.build(triangles);
    expectSound(tree, triangles.size());
    if (count >= 9) expectTwin(tree, triangles, 4000);
  }
}

TEST(BoxTree, FollowsWhatMoves) {
  auto triangles = scattered(2000, 0.2f, 3);
  BoxTree tree;
  tree.build(triangles);
  for (BoxTriangle& t : triangles) t.corner.x += 0.1f * t.corner.y;
  EXPECT_TRUE(tree.refit(triangles));
  expectTwin(tree, triangles, 4000);
  triangles = scattered(2000, 0.2f, 4);  // another scene altogether
  EXPECT_FALSE(tree.refit(triangles));
  expectTwin(tree, triangles, 1000);  // right all the same
}

// Nothing; many triangles in one place; sizes that shrink forever, whose tree would be a list.
TEST(BoxTree, OddScenes) {
  BoxTree tree;
  tree.build({});
  EXPECT_FALSE(occluded(tree, glm::vec3(0), glm::vec3(0, 0, 1), 10.0f));
  const std::vector<BoxTriangle> same(10000, {{-1, -1, 1}, {4, 0, 0}, {0, 4, 0}});
  tree.build(same);
  expectSound(tree, same.size());
  EXPECT_TRUE(occluded(tree, glm::vec3(0), glm::vec3(0, 0, 1), 10.0f));
  EXPECT_FALSE(occluded(tree, glm::vec3(0), glm::vec3(0, 0, 1), 0.5f));
  std::vector<BoxTriangle> shrinking;
  for (int i = 0; i < 4000; ++i) {
    const float size = std::pow(0.97f, float(i));
    shrinking.push_back({{size, 0, 0}, {0, size, 0}, {0, 0, size}});
  }
  tree.build(shrinking);
  expectSound(tree, shrinking.size());
  EXPECT_LE(depthOf(tree), kBoxDepth);
}

}  // namespace
}  // namespace gloam::visibility
