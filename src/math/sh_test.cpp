// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gloam/sh.h>
#include <gtest/gtest.h>

#include <cmath>

#include "math/quadrature.h"
#include "math/sampling.h"
#include "math/sh_batch.h"
#include "math/sh_exact.h"
#include "math/sh_reference.h"
#include "math/simd_test_targets.h"

namespace gloam::sh {
namespace {

TEST(ShBasis, ConventionsAreThoseOfTheDocument) {
  EXPECT_EQ(coefficientCount(4), 16);
  EXPECT_EQ(index(0, 0), 0);
  EXPECT_EQ(index(3, -3), 9);
  EXPECT_EQ(index(5, 5), 35);
  const glm::vec3 d = glm::normalize(glm::vec3(0.3f, -0.5f, 0.7f));
  const Sh y = evaluate(2, d);
  EXPECT_FLOAT_EQ(y[0], 0.28209479f);
  EXPECT_FLOAT_EQ(y[1], 0.48860251f * d.y);
  EXPECT_FLOAT_EQ(y[2], 0.48860251f * d.z);
  EXPECT_FLOAT_EQ(y[3], 0.48860251f * d.x);
}

TEST(ShBasis, IsOrthonormal) {
  for (int i = 0; i < kMaxCoefficients; ++i) {
    const Sh row = project(
        kMaxOrder, [i](const glm::vec3& d) { return evaluate(kMaxOrder, d)[i]; }, 12);
    for (int j = 0; j < kMaxCoefficients; ++j)
      EXPECT_NEAR(row[j], i == j ? 1.0f : 0.0f, 2e-6f) << i << ' ' << j;
  }
}

TEST(ShBasis, EqualsItsDefinition) {
  for (const glm::vec3& d : sampling::fibonacciSphere(500))
    for (int order = 1; order <= kMaxOrder; ++order) {
      const Sh y = evaluate(order, d);
      EXPECT_LT(reference::relativeError(y, reference::evaluate(order, reference::toDirection(d))), 1e-6);
      for (int i = coefficientCount(order); i < kMaxCoefficients; ++i) EXPECT_EQ(y[i], 0.0f);
    }
  for (const glm::vec3& d :
       {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0), glm::vec3(0, -1, 0)})
    EXPECT_LT(reference::relativeError(evaluate(6, d), reference::evaluate(6, reference::toDirection(d))),
              1e-6);
}

TEST(ShBasis, ManyEqualOneByOneOnEveryInstructionSet) {
  onEveryTarget([](const char* name) {
    SCOPED_TRACE(name);
    for (const std::size_t count : {0u, 1u, 7u, 15u, 16u, 17u, 100u}) {
      std::vector<float> x, y, z;
      for (const glm::vec3& d : sampling::stratifiedSphere(8, 3)) {
        if (x.size() == count) break;
        x.push_back(d.x), y.push_back(d.y), z.push_back(d.z);
      }
      for (int order = 1; order <= kMaxOrder; ++order) {
        const std::size_t stride = planeStride(count),
                          size = static_cast<std::size_t>(coefficientCount(order));
        std::vector<float> out(size * stride, -7.0f);
        evaluateMany(order, x, y, z, out, stride);
        for (std::size_t k = 0; k < stride; ++k)
          for (std::size_t i = 0; i < size; ++i) {
            if (k >= count) {
              EXPECT_EQ(out[i * stride + k], -7.0f) << "written past the batch";
            } else {
              EXPECT_NEAR(out[i * stride + k], evaluate(order, {x[k], y[k], z[k]})[static_cast<int>(i)],
                          1e-6f);
            }
          }
      }
    }
  });
}

TEST(ShBasis, ManyAreAccurate) {
  std::vector<float> x, y, z;
  for (const glm::vec3& d : sampling::stratifiedSphere(16, 5))
    x.push_back(d.x), y.push_back(d.y), z.push_back(d.z);
  onEveryTarget([&](const char* name) {
    SCOPED_TRACE(name);
    const std::size_t stride = planeStride(x.size());
    std::vector<float> out(36 * stride);
    evaluateMany(6, x, y, z, out, stride);
    double worst = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      std::array<float, 36> one;
      for (std::size_t i = 0; i < 36; ++i) one[i] = out[i * stride + k];
      worst = std::max(worst, reference::relativeError(one, reference::evaluate(6, {x[k], y[k], z[k]})));
    }
    RecordProperty(std::string("worst_relative_error_") + name, fmt::format("{:.1e}", worst));
    EXPECT_LT(worst, 1e-6);
  });
}

TEST(ShBasis, BadArgumentsAreErrors) {
  EXPECT_THROW(evaluate(0, {0, 0, 1}), Error);
  EXPECT_THROW(evaluate(7, {0, 0, 1}), Error);
  std::vector<float> three(3), two(2), out(100);
  EXPECT_THROW(evaluateMany(2, three, two, three, out, 16), Error);
  EXPECT_THROW(evaluateMany(2, three, three, three, std::span(out).first(10), 3), Error);
  EXPECT_THROW(evaluateMany(2, three, three, three, out, 2), Error);
  EXPECT_THROW(evaluateMany(3, three, three, three, out, ~std::size_t{0} / 2), Error);
  EXPECT_NO_THROW(evaluateMany(2, three, three, three, std::span(out).first(12), 3));
}

TEST(ShZonal, TurnedFunctionIsSymmetricAboutItsAxis) {
  Zh zonal{6, {0.7f, -0.3f, 0.5f, 0.2f, -0.6f, 0.1f}};
  Sh upright(6);
  for (int l = 0; l < 6; ++l) upright[index(l, 0)] = zonal[l];
  for (const glm::vec3& axis : sampling::fibonacciSphere(20)) {
    const Sh turned = rotateZonal(zonal, axis);
    const glm::mat3 frame = sampling::frame(axis);
    for (const glm::vec3& s : sampling::fibonacciSphere(10))
      EXPECT_NEAR(valueAt(turned, frame * s), valueAt(upright, s), 2e-6f);
  }
}

TEST(ShConvolution, ClampedCosineFactorsEqualTheirIntegrals) {
  const GaussLegendre<double> rule(16);
  const float want[] = {3.14159265f, 2.0943951f, 0.78539816f, 0.0f, -0.13089969f, 0.0f};
  for (int l = 0; l < kMaxOrder; ++l) {
    // A_l = 2 pi * integral over 0 < t < 1 of t P_l(t).
    double integral = 0.0;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double t = 0.5 + 0.5 * rule.nodes[i];
      integral += 0.5 * rule.weights[i] * 2.0 * exact::kPi * t * std::legendre(static_cast<unsigned>(l), t);
    }
    EXPECT_NEAR(integral, clampedCosineFactor(l), 1e-6);
    EXPECT_NEAR(clampedCosineFactor(l), want[l], 1e-7f);
    EXPECT_NEAR(clampedCosine(6)[l] * zonalFactor(l), want[l], 1e-6f);
  }
}

TEST(ShConvolution, EqualsTheIntegral) {
  sampling::Rng random(4);
  Sh f(6);
  for (float& value : f.c) value = random.next() - 0.5f;
  const Zh kernel{6, {1.0f, 0.8f, -0.4f, 0.3f, 0.2f, -0.1f}};
  const Sh convolved = convolve(f, kernel);
  for (const glm::vec3& n : sampling::fibonacciSphere(8)) {
    const Sh turned = rotateZonal(kernel, n);
    const auto integral = reference::integrate([&](const reference::Direction& s) {
      return reference::valueAt(reference::toVector(6, f.c), s) *
             reference::valueAt(reference::toVector(6, turned.c), s);
    });
    EXPECT_NEAR(valueAt(convolved, n), integral, 5e-6);
  }
}

TEST(ShConvolution, IrradianceOfWhiteLightIsPi) {
  for (int order = 1; order <= kMaxOrder; ++order)
    EXPECT_NEAR(irradiance(constantSky(order, glm::vec3(1.0f)), glm::normalize(glm::vec3(1, 2, 3))).y,
                3.14159265f, 1e-5f);
  const ShRgb light = colored(directionalLight(3, {0, 1, 0}), glm::vec3(2.0f, 1.0f, 0.5f));
  EXPECT_NEAR(irradiance(light, {0, 1, 0}).x, 2.0f * 17.0f / 16.0f, 1e-5f);  // order 3 is 6 % high head-on
}

TEST(ShTypes, SumsDotsAndTruncation) {
  Sh a = evaluate(3, {0, 0, 1}), b = evaluate(5, {0, 1, 0});
  const float common = dot(a, b);
  EXPECT_NEAR(common, dot(truncated(b, 3), a), 1e-7f);
  a += b;
  EXPECT_EQ(a.order, 5);
  EXPECT_EQ(a[20], b[20]);
  EXPECT_EQ(truncated(b, 6)[30], 0.0f);
  EXPECT_EQ(b.coefficients().size(), 25u);
  EXPECT_THROW(truncated(b, 9), Error);
}

}  // namespace
}  // namespace gloam::sh
