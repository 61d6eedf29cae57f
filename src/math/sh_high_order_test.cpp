// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "math/sh_high_order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "math/sh_reference.h"

namespace gloam::sh {
namespace {

std::vector<glm::vec3> someDirections(int count) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  std::vector<glm::vec3> directions = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
  while (int(directions.size()) < count)
    directions.push_back(glm::normalize(glm::vec3(normal(random), normal(random), normal(random))));
  return directions;
}

TEST(ShHighOrder, BasisIsThatOfTheDefinition) {
  std::vector<double> y(kMaxHighCoefficients);
  for (const glm::vec3& direction : someDirections(20)) {
    evaluateHigh(kMaxHighOrder, glm::normalize(glm::dvec3(direction)), y);
    const reference::Vector want = reference::evaluate(kMaxHighOrder, reference::toDirection(direction));
    for (std::size_t i = 0; i < y.size(); ++i) ASSERT_NEAR(y[i], double(want[i]), 1e-6);
    const Sh low = evaluate(6, direction);
    for (int i = 0; i < 36; ++i) ASSERT_NEAR(y[std::size_t(i)], double(low[i]), 1e-5);
  }
}

TEST(ShHighOrder, HemisphereIsItsProjection) {
  const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, -0.8f, 0.4f));
  std::vector<float> got(kMaxHighCoefficients);
  hemisphereHigh(kMaxHighOrder, normal, got);
  // Turned to +Z a ring falls on neither side, so that quadrature in z is exact in each half.
  std::vector<float> up(kMaxHighCoefficients);
  hemisphereHigh(kMaxHighOrder, {0, 0, 1}, up);
  EXPECT_NEAR(up[0], std::sqrt(3.14159265f), 1e-6f);             // 2 pi / sqrt(4 pi)
  EXPECT_NEAR(up[2], std::sqrt(3.0f * 3.14159265f) / 2, 1e-6f);  // 2 pi sqrt(3 / 4 pi) / 2
  EXPECT_NEAR(up[6], 0.0f, 1e-6f);
  float sum = 0.0f, want = 0.0f;
  for (int k = 0; k < kMaxHighCoefficients; ++k) sum += got[std::size_t(k)] * got[std::size_t(k)];
  for (int k = 0; k < kMaxHighCoefficients; ++k) want += up[std::size_t(k)] * up[std::size_t(k)];
  EXPECT_NEAR(sum, want, 1e-5f);
  // Values far from the edge: 1 above, 0 below, but for ringing.
  std::vector<double> y(kMaxHighCoefficients);
  evaluateHigh(kMaxHighOrder, glm::dvec3(normal), y);
  double above = 0.0, below = 0.0;
  for (int k = 0; k < kMaxHighCoefficients; ++k) {
    above += y[std::size_t(k)] * double(got[std::size_t(k)]);
    below += y[std::size_t(k)] * double(got[std::size_t(k)]) * (bool(int(std::sqrt(k + 0.5)) % 2) ? -1 : 1);
  }
  EXPECT_NEAR(above, 1.0, 0.2);
  EXPECT_NEAR(below, 0.0, 0.2);
}

// Sum over k of Gamma V against the sum over directions of y_i y_j: the same for any set of directions.
TEST(ShHighOrder, TriplingGivesTheMatrixOfDirectQuadrature) {
  const std::vector<glm::vec3> directions = someDirections(40);
  for (const auto& [a, b] : {std::pair(3, 3), {3, 5}, {5, 5}, {4, 6}, {6, 6}}) {
    const Tripling& tripling = Tripling::of(a, b);
    const std::size_t count = std::size_t(tripling.visibilityOrder() * tripling.visibilityOrder());
    std::vector<float> visibility(count, 0.0f), packed(std::size_t(tripling.shape().size()));
    std::vector<double> want(packed.size(), 0.0), y(count), sums(count, 0.0);
    for (const glm::vec3& direction : directions) {
      evaluateHigh(tripling.visibilityOrder(), glm::normalize(glm::dvec3(direction)), y);
      for (std::size_t k = 0; k < count; ++k) sums[k] += y[k];
      for (int i = 0; i < b * b; ++i) {
        for (int j = 0; j < std::min(i + 1, a * a); ++j)
          want[std::size_t(tripling.shape().at(i, j))] += y[std::size_t(i)] * y[std::size_t(j)];
      }
    }
    for (std::size_t k = 0; k < count; ++k) visibility[k] = float(sums[k]);
    tripling.expand(visibility, packed);
    for (std::size_t e = 0; e < want.size(); ++e) ASSERT_NEAR(packed[e], want[e], 3e-5 * 40) << a << b << e;

    std::vector<glm::vec3> light(std::size_t(a * a));
    for (std::size_t j = 0; j < light.size(); ++j) light[j] = {std::sin(float(j)), 1.0f, std::cos(float(j))};
    const auto p = tripling.lightMatrix(light, int(count));
    for (int i = 0; i < b * b; ++i) {
      glm::vec3 by_matrix(0.0f), by_light(0.0f);
      for (int j = 0; j < a * a; ++j)
        by_matrix += packed[std::size_t(tripling.shape().at(i, j))] * light[std::size_t(j)];
      for (std::size_t k = 0; k < count; ++k) by_light += p[std::size_t(i) * count + k] * visibility[k];
      ASSERT_NEAR(by_matrix.x, by_light.x, 5e-3f);
      ASSERT_NEAR(by_matrix.y, by_light.y, 5e-3f);
    }
  }
  // The tensor of products among six bands is part of it.
  EXPECT_NEAR(gamma(6, 2, 2), 0.2523133f, 1e-6f);
}

TEST(ShHighOrder, RotationIsThatOfSixBandsAndOfDeltas) {
  const glm::mat3 turn =
      glm::mat3(glm::rotate(glm::mat4(1.0f), 1.1f, glm::normalize(glm::vec3(1, 2, -0.5f)))) *
      glm::mat3(-1, 0, 0, 0, 1, 0, 0, 0, 1);
  const HighRotation rotation(kMaxHighOrder, turn);
  std::vector<double> y(kMaxHighCoefficients), turned(kMaxHighCoefficients);
  const glm::vec3 direction = glm::normalize(glm::vec3(0.2f, 0.5f, -0.7f));
  evaluateHigh(kMaxHighOrder, glm::normalize(glm::dvec3(direction)), y);
  evaluateHigh(kMaxHighOrder, glm::normalize(glm::dvec3(turn * direction)), turned);
  const std::vector<float> in(y.begin(), y.end());
  std::vector<float> out(in.size());
  rotation.apply(kMaxHighOrder, in.data(), 1, out.data(), 1);
  for (std::size_t k = 0; k < out.size(); ++k) ASSERT_NEAR(out[k], float(turned[k]), 1e-5f);
  Sh low(6);
  std::copy_n(in.begin(), 36, low.c.begin());
  const Sh want = rotate(turn, low);
  for (int i = 0; i < 36; ++i) ASSERT_NEAR(out[std::size_t(i)], want[i], 1e-5f);
  EXPECT_TRUE(HighRotation(5, glm::mat3(1.0f)).isIdentity());
}

TEST(ShHighOrder, OrdersOutOfRangeAreRefused) {
  EXPECT_THROW(Tripling::of(4, 3), Error);
  EXPECT_THROW(Tripling::of(3, 7), Error);
  EXPECT_THROW(Tripling::of(0, 3), Error);
}

}  // namespace
}  // namespace gloam::sh
