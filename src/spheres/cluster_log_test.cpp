// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Log visibility by cuts of the tree, with ratio vectors (SS-3): near the sum over all spheres, continuous where cuts change.
#include "spheres/cluster_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "math/sampling.h"

namespace gloam::spheres {
namespace {

constexpr float kPi = 3.14159265f;

/// Balls strewn over a ground of 20 x 20.
std::vector<Sphere> strewn(int count) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < count; ++i) {
    const glm::vec2 place = sampling::r2(std::uint32_t(i));
    spheres.push_back({{20.0f * place.x - 10.0f, 0.12f, 20.0f * place.y - 10.0f}, 0.12f});
  }
  return spheres;
}

const sh::LogBlockerTable& table() {
  static const sh::LogBlockerTable table = sh::makeLogBlockerTable(4);
  return table;
}

float distanceOf(const sh::Sh& a, const sh::Sh& b) {
  float sum = 0.0f;
  for (int i = 0; i < 16; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// Irradiance under a white sky on a floor, of what an unshadowed one has.
float lightOf(const sh::Sh& log) {
  const sh::Sh open = sh::exponential(log);
  const sh::Sh cosine = sh::rotateZonal(sh::clampedCosine(4), {0, 1, 0});
  float sum = 0.0f;
  for (int i = 0; i < 16; ++i) sum += open[i] * cosine[i];
  return sum / kPi;
}

/// The cluster of a grid of cells of that width that a receiver on the ground lies in.
Sphere clusterAt(const glm::vec3& receiver, float width) {
  const glm::vec3 middle(width * (std::floor(receiver.x / width) + 0.5f), receiver.y,
                         width * (std::floor(receiver.z / width) + 0.5f));
  return {middle, 0.7072f * width};
}

TEST(ClusterLog, OfOneSphereAndOfCutsAtTheLeavesIsTheSum) {
  const std::vector<Sphere> spheres = strewn(40);
  const SphereTree tree = makeSphereTree(spheres);
  const glm::vec3 receiver(0.3f, 0.0f, 0.2f);
  const CutLimits fine{.sin_coarse = 1e-4f, .sin_fine = 2e-4f};
  const ClusterLog cut(tree, spheres, {receiver, 0.5f}, table(), fine);
  EXPECT_EQ(cut.termsAt(receiver), spheres.size());
  EXPECT_LT(distanceOf(cut.at(receiver), logOfSpheres(table(), spheres, receiver)), 1e-4f);
  EXPECT_EQ(distanceOf(ClusterLog({}, {}, {}, table()).at(receiver), sh::Sh{}), 0.0f);
}

// From the place where its ratio vector was made a group sends each band of its leaves' sum, projected on its own: the mean exactly.
TEST(ClusterLog, RatiosKeepTheMeanAtTheClustersCentre) {
  const std::vector<Sphere> spheres = strewn(300);
  const SphereTree tree = makeSphereTree(spheres);
  for (const glm::vec3 place : {glm::vec3(0, 0, 0), glm::vec3(30, 2, 0), glm::vec3(-7, 5, 3)}) {
    const sh::Sh all = logOfSpheres(table(), spheres, place);
    const sh::Sh got = ClusterLog(tree, spheres, {place, 0.3f}, table()).at(place);
    EXPECT_NEAR(got[0], all[0], 2e-4f * std::abs(all[0]));
    EXPECT_LT(distanceOf(got, all), 0.1f * distanceOf(all, sh::Sh{})) << place.x;
  }
}

TEST(ClusterLog, CutsNeedFewerSpheresAndShowNearlyTheSame) {
  const std::vector<Sphere> spheres = strewn(500);
  const SphereTree tree = makeSphereTree(spheres);
  std::size_t terms = 0;
  int places = 0;
  float worst = 0.0f;
  for (float x = -9.0f; x < 9.0f; x += 1.3f, ++places) {
    const glm::vec3 receiver(x, 0.0f, 0.4f * x);
    const ClusterLog cut(tree, spheres, clusterAt(receiver, 0.5f), table());
    terms += cut.termsAt(receiver);
    const float want = lightOf(logOfSpheres(table(), spheres, receiver));
    worst = std::max(worst, std::abs(lightOf(cut.at(receiver)) - want) / want);
  }
  EXPECT_LT(terms, std::size_t(places) * spheres.size() / 4);
  EXPECT_LT(worst, 0.015f);
}

// Terms and errors of the README: a reach of 15 radii sums fewer spheres than a cut, and loses more light by far.
TEST(ClusterLog, ComparedWithReach) {
  for (const int count : {200, 2000}) {
    const std::vector<Sphere> spheres = strewn(count);
    const SphereTree tree = makeSphereTree(spheres);
    double reach_error = 0.0, cut_error = 0.0;
    std::size_t reach_terms = 0, cut_terms = 0;
    constexpr int kReceivers = 60;
    for (int i = 0; i < kReceivers; ++i) {
      const glm::vec2 u = sampling::r2(std::uint32_t(1000 + i));
      const glm::vec3 receiver(18.0f * u.x - 9.0f, 0.0f, 18.0f * u.y - 9.0f);
      std::vector<Sphere> near;
      for (const Sphere& sphere : spheres) {
        if (glm::distance(sphere.center, receiver) < 15.0f * sphere.radius) near.push_back(sphere);
      }
      const ClusterLog cut(tree, spheres, clusterAt(receiver, 0.5f), table());
      const float want = lightOf(logOfSpheres(table(), spheres, receiver));
      const double reached = lightOf(logOfSpheres(table(), near, receiver)) / want - 1.0,
                   through_cut = lightOf(cut.at(receiver)) / want - 1.0;
      reach_error += reached * reached, cut_error += through_cut * through_cut;
      reach_terms += near.size(), cut_terms += cut.termsAt(receiver);
    }
    RecordProperty(std::to_string(count), "terms " + std::to_string(double(reach_terms) / kReceivers) +
                                              " and " + std::to_string(double(cut_terms) / kReceivers) +
                                              ", RMS " + std::to_string(std::sqrt(reach_error / kReceivers)) +
                                              " and " + std::to_string(std::sqrt(cut_error / kReceivers)));
    EXPECT_LT(reach_terms, cut_terms);
    EXPECT_LT(std::sqrt(cut_error), 0.3 * std::sqrt(reach_error)) << count;
  }
}

// A receiver walks over the ground from cluster to cluster: shading follows the full sum without jumps. Bounds alone, as they are, are much too
// dark, and jump by whole groups.
TEST(ClusterLog, ShadingIsContinuousBetweenCuts) {
  const std::vector<Sphere> spheres = strewn(200);
  const SphereTree tree = makeSphereTree(spheres);
  constexpr float kStep = 0.004f, kWidth = 0.5f;
  float worst = 0.0f, worst_plain = 0.0f, before = 0.0f, before_plain = 0.0f, before_all = 0.0f;
  for (int i = 0; i < 600; ++i) {
    const glm::vec3 receiver(-1.2f + kStep * float(i), 0.0f, 0.3f + 0.5f * kStep * float(i));
    const Sphere cluster = clusterAt(receiver, kWidth);
    const float light = lightOf(ClusterLog(tree, spheres, cluster, table()).at(receiver));
    std::vector<Sphere> bounds;
    for (const int n : cutSphereTree(tree, cluster, 0.5f)) bounds.push_back(tree.nodes[std::size_t(n)].bound);
    const float plain = lightOf(logOfSpheres(table(), bounds, receiver));
    const float all = lightOf(logOfSpheres(table(), spheres, receiver));
    if (i > 0) {
      worst = std::max(worst, std::abs((light - before) - (all - before_all)));
      worst_plain = std::max(worst_plain, std::abs((plain - before_plain) - (all - before_all)));
    }
    before = light, before_plain = plain, before_all = all;
  }
  EXPECT_LT(worst, 0.004f) << worst_plain;
  EXPECT_GT(worst_plain, 3.0f * worst);
}

TEST(ClusterLog, RefusesLimitsOutOfOrderAndOtherSpheres) {
  const std::vector<Sphere> spheres = strewn(5);
  const SphereTree tree = makeSphereTree(spheres);
  const CutLimits wrong[] = {{0.0f, 0.2f}, {0.3f, 0.2f}, {0.2f, 1.5f}, {NAN, 0.2f}};
  for (const CutLimits& limits : wrong)
    EXPECT_THROW(ClusterLog(tree, spheres, {}, table(), limits), Error) << limits.sin_coarse;
  EXPECT_THROW(ClusterLog(tree, strewn(4), {}, table()), Error);
}

}  // namespace
}  // namespace gloam::spheres
