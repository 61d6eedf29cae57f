// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gloam/sh.h>
#include <gtest/gtest.h>

#include <cmath>

#include "math/quadrature.h"
#include "math/sampling.h"
#include "math/sh_reference.h"
#include "math/sh_tables.h"
#include "math/simd_test_targets.h"

namespace gloam::sh {
namespace {

Sh randomFunction(int order, sampling::Rng& random) {
  Sh f(order);
  for (int i = 0; i < f.size(); ++i) f[i] = random.next() - 0.5f;
  return f;
}

reference::Vector toVector(const Sh& f) {
  return reference::toVector(f.order, f.c);
}

TEST(ShProduct, GammaHasTheKnownNumberOfNonZeros) {
  const int want[] = {1, 10, 83, 353, 1158, 2907};
  for (int order = 1; order <= kMaxOrder; ++order) EXPECT_EQ(gammaNonZeros(order), want[order - 1]);
}

TEST(ShProduct, GammaEqualsQuadrature) {
  // Gauss rings and even columns integrate degree 15 exactly; all 46,656 entries from one table of the basis.
  const int rings = 10;
  std::vector<reference::Vector> basis;
  std::vector<long double> weights;
  const GaussLegendre<long double> rule(rings);
  for (std::size_t ring = 0; ring < rule.nodes.size(); ++ring)
    for (int column = 0; column < 2 * rings; ++column) {
      const long double z = rule.nodes[ring], r = std::sqrt(1.0L - z * z),
                        step = 3.14159265358979323846L / rings;
      basis.push_back(reference::evaluate(6, {r * std::cos(step * column), r * std::sin(step * column), z}));
      weights.push_back(rule.weights[ring] * step);
    }
  double worst = 0.0;
  for (std::size_t i = 0; i < 36; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      for (std::size_t k = 0; k <= j; ++k) {
        long double sum = 0;
        for (std::size_t p = 0; p < basis.size(); ++p)
          sum += weights[p] * basis[p][i] * basis[p][j] * basis[p][k];
        const float got = gamma(static_cast<int>(i), static_cast<int>(j), static_cast<int>(k));
        worst = std::max(worst, std::abs(static_cast<double>(sum - got)));
        EXPECT_EQ(std::abs(sum) < 1e-9L, got == 0.0f);
        EXPECT_EQ(got, gamma(static_cast<int>(k), static_cast<int>(i), static_cast<int>(j)));
      }
  EXPECT_LT(worst, 3e-8);
}

TEST(ShProduct, EqualsQuadrature) {
  sampling::Rng random(1);
  double worst = 0.0;
  for (int order = 1; order <= kMaxOrder; ++order)
    for (int i = 0; i < 4; ++i) {
      const Sh f = randomFunction(order, random), g = randomFunction(order, random);
      const auto want = reference::product(order, toVector(f), toVector(g));
      worst = std::max(worst, reference::relativeError(product(f, g), want));
    }
  RecordProperty("worst_relative_error", fmt::format("{:.1e}", worst));
  EXPECT_LT(worst, 1e-6);
}

TEST(ShProduct, MixedOrdersEqualQuadrature) {
  sampling::Rng random(2);
  for (int nf = 1; nf <= kMaxOrder; ++nf)
    for (int ng = 1; ng <= kMaxOrder; ng += 2)
      for (int nh = 1; nh <= kMaxOrder; nh += nh == 1 ? 2 : 3) {
        const Sh f = randomFunction(nf, random), g = randomFunction(ng, random);
        const Sh h = product(f, g, nh);
        EXPECT_EQ(h.order, nh);
        EXPECT_LT(reference::relativeError(h, reference::product(nh, toVector(f), toVector(g))), 2e-6);
        const ShMatrix matrix = productMatrix(f, ng, nh);
        const Sh by_matrix = multiply(matrix, g);
        for (int i = 0; i < h.size(); ++i) EXPECT_NEAR(by_matrix[i], h[i], 1e-6f);
      }
  EXPECT_EQ(product(Sh(2), Sh(5)).order, 5);
}

TEST(ShProduct, MatrixIsSymmetricAndOneIsNeutral) {
  sampling::Rng random(3);
  const Sh f = randomFunction(6, random);
  const ShMatrix matrix = productMatrix(f, 6, 6);
  for (int i = 0; i < 36; ++i)
    for (int k = 0; k < i; ++k) EXPECT_NEAR(matrix.at(i, k), matrix.at(k, i), 1e-7f);
  Sh one(6);
  one[0] = 3.5449077f;
  const Sh same = product(one, f);
  for (int i = 0; i < 36; ++i) EXPECT_NEAR(same[i], f[i], 2e-7f);
  const Sh squared = square(f), product_of_same = product(f, f);
  for (int i = 0; i < 36; ++i) EXPECT_EQ(squared[i], product_of_same[i]);
}

TEST(ShProduct, ZonalLobeThroughAMatrixNeedsNoProduct) {
  // L * H(N) = Q y(N) with Q = M_L diag(A_l).
  sampling::Rng random(4);
  const Sh light = randomFunction(4, random);
  const ShMatrix m = productMatrix(light, 4, 4);
  const glm::vec3 normal = glm::normalize(glm::vec3(1, -2, 0.5f));
  Sh lobe = evaluate(4, normal);
  for (int l = 0; l < 4; ++l)
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) lobe[i] *= clampedCosineFactor(l);
  const Sh by_matrix = multiply(m, lobe), by_product = product(light, rotateZonal(clampedCosine(4), normal));
  for (int i = 0; i < 16; ++i) EXPECT_NEAR(by_matrix[i], by_product[i], 1e-6f);
}

TEST(ShProduct, ColorsMultiplyAlike) {
  sampling::Rng random(5);
  const Sh f = randomFunction(5, random), g = randomFunction(5, random);
  const ShRgb colors = product(colored(f, {1, 2, 3}), g);
  const Sh single = product(f, g);
  for (int i = 0; i < 25; ++i) EXPECT_NEAR(colors[i].z, 3.0f * single[i], 2e-6f);
}

TEST(ShProduct, ManyEqualTheReferenceOnEveryInstructionSet) {
  sampling::Rng random(6);
  const std::size_t count = 37, stride = planeStride(count);
  std::vector<float> f(36 * stride), g(36 * stride);
  for (float& value : f) value = random.next() - 0.5f;
  for (float& value : g) value = random.next() - 0.5f;
  const auto column = [stride](const std::vector<float>& planes, std::size_t k, int order) {
    reference::Vector vector;
    for (std::size_t i = 0; i < static_cast<std::size_t>(order * order); ++i)
      vector.push_back(planes[i * stride + k]);
    return vector;
  };
  std::vector<std::vector<reference::Vector>> wanted(7);
  for (int order = 1; order <= kMaxOrder; ++order)
    for (std::size_t k = 0; k < count; ++k)
      wanted[static_cast<std::size_t>(order)].push_back(
          k % 6 == 0 || k + 1 == count ? reference::product(order, column(f, k, order), column(g, k, order))
                                       : reference::Vector());
  onEveryTarget([&](const char* name) {
    SCOPED_TRACE(name);
    double worst = 0.0;
    for (int order = 1; order <= kMaxOrder; ++order)
      for (const std::size_t part : {count, std::size_t{7}}) {
        std::vector<float> out(36 * stride, -7.0f);
        productMany(order, part, f, g, out, stride);
        EXPECT_EQ(out[part], -7.0f) << "written past the batch";
        for (std::size_t k = 0; k < part; ++k) {
          const reference::Vector& want = wanted[static_cast<std::size_t>(order)][k];
          if (!want.empty()) worst = std::max(worst, reference::relativeError(column(out, k, order), want));
        }
      }
    RecordProperty(std::string("worst_relative_error_") + name, fmt::format("{:.1e}", worst));
    EXPECT_LT(worst, 2e-6);
  });
}

TEST(ShProduct, BadArgumentsAreErrors) {
  EXPECT_THROW(product(Sh(3), Sh(3), 7), Error);
  EXPECT_THROW(productMatrix(Sh(3), 0, 3), Error);
  EXPECT_THROW(gamma(36, 0, 0), Error);
  EXPECT_THROW(gamma(0, -1, 0), Error);
  std::vector<float> planes(100);
  EXPECT_THROW(productMany(6, 4, planes, planes, planes, 4), Error);
}

}  // namespace
}  // namespace gloam::sh
