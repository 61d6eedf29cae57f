// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/sh.h>
#include <gtest/gtest.h>

#include <cmath>

#include "math/quadrature.h"
#include "math/sampling.h"
#include "math/sh_exact.h"
#include "math/sh_reference.h"

namespace gloam::sh {
namespace {

constexpr double kPi = exact::kPi;

Sh randomFunction(int order, std::uint32_t seed) {
  sampling::Rng random(seed);
  Sh f(order);
  for (int i = 0; i < f.size(); ++i) f[i] = random.next() - 0.5f;
  return f;
}

double distance(const Sh& a, const Sh& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.c.size(); ++i) sum += double(a.c[i] - b.c[i]) * double(a.c[i] - b.c[i]);
  return std::sqrt(sum);
}

glm::vec3 equirectangularDirection(int column, int row, int width, int height) {
  const double phi = 2.0 * kPi * ((column + 0.5) / width - 0.5), theta = kPi * (0.5 - (row + 0.5) / height);
  return {std::cos(phi) * std::cos(theta), std::sin(theta), std::sin(phi) * std::cos(theta)};
}

TEST(ShProjection, FunctionComesBack) {
  for (int order = 1; order <= kMaxOrder; ++order) {
    const Sh f = randomFunction(order, 7);
    EXPECT_LT(distance(project(
                           order, [&](const glm::vec3& d) { return valueAt(f, d); }, 6),
                       f),
              2e-6);
    const ShRgb colors = projectRgb(
        order, [&](const glm::vec3& d) { return valueAt(f, d) * glm::vec3(1, 2, 3); }, 6);
    EXPECT_NEAR(colors[0].z, 3.0f * f[0], 2e-6f);
  }
  EXPECT_THROW(project(
                   3, [](const glm::vec3&) { return 1.0f; }, 0),
               Error);
}

TEST(ShProjection, DiscOfAnySizeEqualsQuadratureOverIt) {
  const glm::vec3 axis = glm::normalize(glm::vec3(0.2f, 0.9f, -0.4f));
  const GaussLegendre<long double> rule(12);
  for (const float angle : {1e-4f, 0.00465f, 0.3f, 1.0f, 1.5707964f, 2.5f, 3.1415925f}) {
    const Zh zonal = discZonal(6, angle);
    for (int l = 0; l < 6; ++l) {
      // 2 pi N_l0 integral of P_l over (cos a, 1), in t = 1 - 2 sin^2(a / 2) u.
      const long double height = 2.0L * std::sin(0.5L * angle) * std::sin(0.5L * angle);
      long double integral = 0;
      for (std::size_t i = 0; i < rule.nodes.size(); ++i)
        integral += 0.5L * height * rule.weights[i] *
                    std::legendre(static_cast<unsigned>(l), 1.0L - height * (0.5L + 0.5L * rule.nodes[i]));
      const long double want = 2.0L * kPi * exact::normalization(l, 0) * integral;
      EXPECT_NEAR(zonal[l], want, 2e-6L * std::abs(want) + 3e-7L) << angle << ' ' << l;
    }
  }
  // A small disc is a directional light times its solid angle.
  const Sh small = disc(6, axis, 1e-4f), delta = directionalLight(6, axis);
  for (int i = 0; i < 36; ++i) EXPECT_NEAR(small[i] / (kPi * 1e-8), delta[i], 1e-5);
  Sh whole(6);
  whole[0] = 3.5449077f;
  EXPECT_LT(distance(disc(6, axis, 3.1415927f), whole), 2e-6);
  EXPECT_THROW(disc(3, axis, -0.1f), Error);
  EXPECT_THROW(disc(3, axis, NAN), Error);
}

TEST(ShProjection, SkiesEqualQuadrature) {
  EXPECT_NEAR(valueAt(constantSky(4, {1, 2, 3}), {0, 1, 0}).z, 3.0f, 1e-6f);
  const glm::vec3 zenith(0.1f, 0.3f, 0.9f), horizon(0.8f, 0.8f, 0.7f), nadir(0.3f, 0.2f, 0.1f);
  const ShRgb sky = gradientSky(6, zenith, horizon, nadir);
  const ShRgb sampled = projectRgb(
      6,
      [&](const glm::vec3& d) {
        return d.y > 0.0f ? glm::mix(horizon, zenith, d.y) : glm::mix(horizon, nadir, -d.y);
      },
      200);
  for (int i = 0; i < 36; ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sky[i][c], sampled[i][c], 2e-4f) << i;
  // Linear from pole to pole: bands 0 and 1 say it all.
  const ShRgb linear = gradientSky(2, glm::vec3(1.0f), glm::vec3(0.5f), glm::vec3(0.0f));
  EXPECT_NEAR(valueAt(linear, glm::normalize(glm::vec3(1, 1, 0))).x, 0.5f + 0.5f * std::sqrt(0.5f), 1e-6f);
}

TEST(ShProjection, TexelSolidAnglesSumToTheSphere) {
  for (const int height : {1, 2, 7, 64}) {
    double sum = 0.0;
    for (int row = 0; row < height; ++row)
      sum += 2.0 * height * equirectangularSolidAngle(row, 2 * height, height);
    EXPECT_NEAR(sum, 4.0 * kPi, 2e-6);
  }
  for (const int size : {1, 2, 5, 32}) {
    double sum = 0.0;
    for (int row = 0; row < size; ++row)
      for (int column = 0; column < size; ++column) sum += 6.0 * cubeSolidAngle(column, row, size);
    EXPECT_NEAR(sum, 4.0 * kPi, 5e-6);
  }
}

TEST(ShProjection, EquirectangularPictureOfAFunction) {
  const int width = 256, height = 128;
  const Sh f = randomFunction(6, 11);
  std::vector<glm::vec3> texels;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const float value = valueAt(f, equirectangularDirection(column, row, width, height));
      texels.emplace_back(value, 2.0f * value, 1.0f);
    }
  const ShRgb projected = projectEquirectangular(6, texels, width, height);
  for (int i = 0; i < 36; ++i) {
    EXPECT_NEAR(projected[i].x, f[i], 1e-3f) << i;
    EXPECT_NEAR(projected[i].y, 2.0f * f[i], 2e-3f) << i;
    EXPECT_NEAR(projected[i].z, i == 0 ? 3.5449077f : 0.0f, 1e-6f) << i;
  }
}

TEST(ShProjection, EquirectangularIsExactForConstantTexels) {
  // One bright texel: quadrature over its very area, many points.
  const int width = 8, height = 4, column = 5, row = 1;
  std::vector<glm::vec3> texels(static_cast<std::size_t>(width * height));
  texels[static_cast<std::size_t>(row * width + column)] = glm::vec3(2.0f);
  const ShRgb projected = projectEquirectangular(6, texels, width, height);
  const GaussLegendre<double> rule(16);
  std::array<double, 36> want{};
  const double top = std::cos(row * kPi / height), bottom = std::cos((row + 1) * kPi / height);
  const double step = 2.0 * kPi / width;
  for (std::size_t i = 0; i < 16; ++i)
    for (std::size_t j = 0; j < 16; ++j) {
      const double y = 0.5 * (top + bottom) + 0.5 * (top - bottom) * rule.nodes[i],
                   r = std::sqrt(1.0 - y * y);
      const double phi = -kPi + (column + 0.5 + 0.5 * rule.nodes[j]) * step;
      const Sh basis = evaluate(6, glm::vec3(r * std::cos(phi), y, r * std::sin(phi)));
      const double weight = 0.25 * rule.weights[i] * rule.weights[j] * (top - bottom) * step;
      for (std::size_t k = 0; k < 36; ++k) want[k] += 2.0 * weight * double(basis[static_cast<int>(k)]);
    }
  for (std::size_t k = 0; k < 36; ++k) EXPECT_NEAR(projected[static_cast<int>(k)].x, want[k], 2e-6) << k;
}

TEST(ShProjection, EquirectangularKeepsDirections) {
  // A light at +X stands in the middle of the picture, at +Z a quarter to the right, +Y in the first row.
  const auto brightest = [](int column, int row) {
    std::vector<glm::vec3> texels(64 * 32);
    texels[static_cast<std::size_t>(row * 64 + column)] = glm::vec3(1.0f);
    const ShRgb f = projectEquirectangular(2, texels, 64, 32);
    return glm::normalize(glm::vec3(f[3].x, f[1].x, f[2].x));
  };
  EXPECT_GT(glm::dot(brightest(32, 16), glm::vec3(1, 0, 0)), 0.99f);
  EXPECT_GT(glm::dot(brightest(48, 16), glm::vec3(0, 0, 1)), 0.99f);
  EXPECT_GT(glm::dot(brightest(16, 16), glm::vec3(0, 0, -1)), 0.99f);
  EXPECT_GT(glm::dot(brightest(3, 0), glm::vec3(0, 1, 0)), 0.99f);
}

TEST(ShProjection, CubeOfAFunction) {
  const int size = 64;
  const Sh f = randomFunction(6, 12);
  std::vector<glm::vec3> texels;
  for (int face = 0; face < 6; ++face)
    for (int row = 0; row < size; ++row)
      for (int column = 0; column < size; ++column) {
        const glm::vec3 d = cubeDirection(face, (static_cast<float>(column) + 0.5f) / size,
                                          (static_cast<float>(row) + 0.5f) / size);
        texels.emplace_back(valueAt(f, d), 1.0f, d.x);
      }
  const ShRgb projected = projectCube(6, texels, size);
  for (int i = 0; i < 36; ++i) {
    EXPECT_NEAR(projected[i].x, f[i], 2e-3f) << i;
    EXPECT_NEAR(projected[i].y, i == 0 ? 3.5449077f : 0.0f, 1e-5f) << i;
    EXPECT_NEAR(projected[i].z, i == 3 ? 2.0466534f : 0.0f, 1e-3f) << i;
  }
}

TEST(ShProjection, SmallCubesOfConstantLightHaveNoOtherBand) {
  for (const int size : {1, 2, 4}) {
    const std::vector<glm::vec3> texels(static_cast<std::size_t>(6 * size * size), glm::vec3(1.0f));
    const ShRgb f = projectCube(6, texels, size);
    EXPECT_NEAR(f[0].x, 3.5449077f, 1e-5f);
    for (int i = 1; i < 36; ++i) EXPECT_NEAR(f[i].x, 0.0f, 2e-6f) << size << ' ' << i;
  }
}

TEST(ShProjection, CubeFacesLieWhereVulkanPutsThem) {
  const glm::vec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int face = 0; face < 6; ++face) EXPECT_EQ(cubeDirection(face, 0.5f, 0.5f), axes[face]);
  EXPECT_GT(cubeDirection(4, 1.0f, 0.5f).x, 0.5f);   // +Z: right is +X
  EXPECT_LT(cubeDirection(4, 0.5f, 1.0f).y, -0.5f);  // rows go down
  EXPECT_LT(cubeDirection(0, 1.0f, 0.5f).z, -0.5f);  // +X: right is -Z
  EXPECT_THROW(cubeDirection(6, 0.5f, 0.5f), Error);
}

TEST(ShProjection, WrongSizesAreErrors) {
  const std::vector<glm::vec3> texels(24);
  EXPECT_THROW(projectEquirectangular(3, texels, 5, 5), Error);
  EXPECT_THROW(projectEquirectangular(3, {}, 0, 0), Error);
  EXPECT_THROW(projectEquirectangular(3, texels, -4, -6), Error);
  EXPECT_THROW(projectCube(3, texels, 3), Error);
  EXPECT_THROW(projectCube(3, texels, 0), Error);
  EXPECT_THROW(projectCube(3, texels, 2147483647), Error);
  EXPECT_THROW(projectEquirectangular(3, texels, 2147483647, 2147483647), Error);
  EXPECT_NO_THROW(projectCube(3, texels, 2));
}

}  // namespace
}  // namespace gloam::sh
