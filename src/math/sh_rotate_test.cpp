// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gloam/sh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "math/sampling.h"
#include "math/sh_reference.h"
#include "math/sh_tables.h"
#include "math/simd_test_targets.h"

namespace gloam::sh {
namespace {

glm::mat3 turned(float angle, const glm::vec3& axis) {
  return glm::mat3(glm::rotate(glm::dmat4(1.0), double(angle), glm::dvec3(axis)));
}

glm::mat3 randomMatrix(sampling::Rng& random) {
  const glm::mat3 frame = sampling::frame(sampling::uniformSphere(random.next2()));
  return frame * turned(6.2831853f * random.next(), {0, 0, 1});
}

/// Matrices that are awkward: the identity and its neighbours, half turns, exchanges of axes, mirrors.
std::vector<glm::mat3> awkwardMatrices() {
  std::vector<glm::mat3> matrices = {glm::mat3(1.0f), glm::mat3(-1.0f)};
  for (const float angle : {1e-7f, 1e-6f, 1e-5f, 1e-4f, 1e-3f, 1e-2f})
    for (const glm::vec3& axis :
         {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1), glm::vec3(1, -2, 3)})
      for (const float whole : {0.0f, 3.14159265f, 1.57079633f})
        matrices.push_back(turned(whole + angle, glm::normalize(axis)));
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 unit(0.0f);
    unit[axis] = 1.0f;
    matrices.push_back(turned(3.14159265f, unit));
    glm::mat3 mirror(1.0f);
    mirror[axis][axis] = -1.0f;
    matrices.push_back(mirror);
  }
  matrices.push_back(glm::mat3({0, 1, 0}, {0, 0, 1}, {1, 0, 0}));
  matrices.push_back(glm::mat3({0, 1, 0}, {1, 0, 0}, {0, 0, 1}));
  return matrices;
}

Sh randomFunction(sampling::Rng& random) {
  Sh f(kMaxOrder);
  for (float& value : f.c) value = random.next() - 0.5f;
  return f;
}

TEST(ShRotation, EqualsReprojection) {
  sampling::Rng random(1);
  std::vector<glm::mat3> matrices = awkwardMatrices();
  for (int i = 0; i < 30; ++i) matrices.push_back(randomMatrix(random) * (i % 3 == 0 ? -1.0f : 1.0f));
  double worst = 0.0;
  for (const glm::mat3& matrix : matrices) {
    const Sh f = randomFunction(random);
    const auto want = reference::rotate(glm::dmat3(matrix), reference::toVector(6, f.c));
    worst = std::max(worst, reference::relativeError(rotate(matrix, f), want));
  }
  RecordProperty("worst_relative_error", fmt::format("{:.1e}", worst));
  EXPECT_LT(worst, 1e-6);
}

TEST(ShRotation, ManyEqualReprojectionOnEveryInstructionSet) {
  sampling::Rng random(2);
  std::vector<glm::mat3> matrices = awkwardMatrices();
  while (matrices.size() < 101)
    matrices.push_back(randomMatrix(random) * (matrices.size() % 3 == 0 ? -1.0f : 1.0f));
  const std::size_t count = matrices.size(), stride = planeStride(count);
  std::vector<float> in(36 * stride);
  for (float& value : in) value = random.next() - 0.5f;
  std::vector<reference::Vector> wanted;
  for (std::size_t k = 0; k < count; ++k) {
    reference::Vector f;
    for (std::size_t i = 0; i < 36; ++i) f.push_back(in[i * stride + k]);
    wanted.push_back(reference::rotate(glm::dmat3(matrices[k]), f));
  }
  onEveryTarget([&](const char* name) {
    SCOPED_TRACE(name);
    double worst = 0.0;
    for (int order = 1; order <= kMaxOrder; ++order) {
      const auto size = static_cast<std::size_t>(coefficientCount(order));
      for (const std::size_t part : {count, std::size_t{5}}) {
        std::vector<float> out(36 * stride, -7.0f);
        rotateMany(order, std::span(matrices).first(part), in, out, stride);
        for (std::size_t k = 0; k < part; ++k) {
          std::vector<float> got;
          for (std::size_t i = 0; i < size; ++i) got.push_back(out[i * stride + k]);
          const reference::Vector want(wanted[k].begin(), wanted[k].begin() + coefficientCount(order));
          worst = std::max(worst, reference::relativeError(got, want));
        }
        EXPECT_EQ(out[part], -7.0f) << "written past the batch";
      }
    }
    RecordProperty(std::string("worst_relative_error_") + name, fmt::format("{:.1e}", worst));
    EXPECT_LT(worst, 2e-6);
  });
}

TEST(ShRotation, OneRotationOfManyEqualsOneByOne) {
  sampling::Rng random(3);
  onEveryTarget([&](const char* name) {
    SCOPED_TRACE(name);
    for (const std::size_t count : {3u, 16u, 50u})
      for (int order = 1; order <= kMaxOrder; ++order) {
        const Rotation rotation = makeRotation(order, randomMatrix(random) * (order % 2 == 0 ? -1.0f : 1.0f));
        const std::size_t stride = planeStride(count),
                          size = static_cast<std::size_t>(coefficientCount(order));
        std::vector<float> in(size * stride), out(size * stride);
        for (float& value : in) value = random.next() - 0.5f;
        rotateMany(rotation, count, in, out, stride);
        for (std::size_t k = 0; k < count; ++k) {
          Sh f(order);
          for (std::size_t i = 0; i < size; ++i) f[static_cast<int>(i)] = in[i * stride + k];
          const Sh want = rotate(rotation, f);
          for (std::size_t i = 0; i < size; ++i)
            EXPECT_NEAR(out[i * stride + k], want[static_cast<int>(i)], 2e-6f);
        }
      }
  });
}

TEST(ShRotation, TurnsTheFunctionWithTheMatrix) {
  sampling::Rng random(4);
  for (int i = 0; i < 20; ++i) {
    const glm::mat3 matrix = randomMatrix(random) * (i % 2 == 0 ? 1.0f : -1.0f);
    const Sh f = randomFunction(random), g = rotate(matrix, f);
    for (const glm::vec3& s : sampling::fibonacciSphere(10))
      EXPECT_NEAR(valueAt(g, matrix * s), valueAt(f, s), 1e-5f);
  }
}

TEST(ShRotation, SmallTurnsAreTheDerivative) {
  // (D(R) f - f) / angle tends to the derivative; any noise near the identity would blow up here.
  sampling::Rng random(5);
  const Sh f = randomFunction(random);
  const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, -1));
  for (const float angle : {1e-2f, 1e-3f, 1e-4f, 1e-5f}) {
    const Sh g = rotate(turned(angle, axis), f);
    for (const glm::vec3& s : sampling::fibonacciSphere(16)) {
      const double h = 1e-3;
      const auto at = [&](double a) {
        return valueAt(f, glm::vec3(turned(static_cast<float>(-a), axis) * s));
      };
      const double slope = (double(at(h)) - double(at(-h))) / (2.0 * h);
      EXPECT_NEAR(double(valueAt(g, s)) - double(valueAt(f, s)), slope * angle, 30.0 * angle * angle + 4e-6)
          << angle;
    }
  }
}

TEST(ShRotation, IdentityChangesNothing) {
  sampling::Rng random(6);
  const Sh f = randomFunction(random), g = rotate(glm::mat3(1.0f), f);
  for (int i = 0; i < 36; ++i) EXPECT_NEAR(g[i], f[i], 2e-7f);
}

TEST(ShRotation, ComposesAndKeepsLength) {
  sampling::Rng random(7);
  for (int i = 0; i < 50; ++i) {
    const glm::mat3 a = i % 5 == 0 ? turned(1e-5f, {0, 0, 1}) : randomMatrix(random),
                    b = randomMatrix(random);
    const Sh f = randomFunction(random), twice = rotate(a, rotate(b, f)), once = rotate(a * b, f);
    for (int k = 0; k < 36; ++k) EXPECT_NEAR(twice[k], once[k], 2e-6f);
    EXPECT_NEAR(dot(once, once), dot(f, f), 1e-5f * dot(f, f));
    const Sh back = rotate(glm::transpose(a), rotate(a, f));
    for (int k = 0; k < 36; ++k) EXPECT_NEAR(back[k], f[k], 2e-6f);
  }
}

TEST(ShRotation, ColorsTurnAlike) {
  sampling::Rng random(8);
  const Sh f = randomFunction(random);
  const glm::mat3 matrix = randomMatrix(random);
  const ShRgb colors = rotate(matrix, colored(f, {1, 2, -1}));
  const Sh single = rotate(matrix, f);
  for (int i = 0; i < 36; ++i) EXPECT_NEAR(colors[i].y, 2.0f * single[i], 1e-6f);
}

TEST(ShRotation, ExchangeIsAnInvolutionAndSparse) {
  for (std::size_t l = 0; l < kMaxOrder; ++l) {
    const auto& j = tables::kExchange[l];
    int non_zeros = 0;
    for (std::size_t r = 0; r <= 2 * l; ++r)
      for (std::size_t c = 0; c <= 2 * l; ++c) {
        double sum = 0.0;
        for (std::size_t k = 0; k <= 2 * l; ++k) sum += double(j[r][k]) * double(j[k][c]);
        EXPECT_NEAR(sum, r == c ? 1.0 : 0.0, 3e-7);
        non_zeros += j[r][c] != 0.0f;
      }
    EXPECT_LE(non_zeros, static_cast<int>((2 * l + 1) * (2 * l + 1) + 3) / 4 + static_cast<int>(l) + 1);
  }
}

TEST(ShRotation, BadArgumentsAreErrors) {
  EXPECT_THROW(makeRotation(7, glm::mat3(1.0f)), Error);
  EXPECT_THROW(rotate(makeRotation(3, glm::mat3(1.0f)), Sh(4)), Error);
  std::vector<glm::mat3> matrices(4, glm::mat3(1.0f));
  std::vector<float> in(36 * 4), out(36 * 4);
  EXPECT_THROW(rotateMany(6, matrices, in, out, 3), Error);
  EXPECT_THROW(rotateMany(6, matrices, in, std::span(out).first(100), 4), Error);
}

}  // namespace
}  // namespace gloam::sh
