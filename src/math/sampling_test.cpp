// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "math/sampling.h"

#include <gloam/error.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace gloam::sampling {
namespace {

/// Chi-square of a histogram against equal shares, in standard deviations from its mean.
double chiSquareDeviations(const std::vector<int>& histogram, int total) {
  const double expected = double(total) / double(histogram.size()), freedom = double(histogram.size()) - 1.0;
  double chi = 0.0;
  for (const int count : histogram) chi += (count - expected) * (count - expected) / expected;
  return (chi - freedom) / std::sqrt(2.0 * freedom);
}

TEST(Rng, IsAFunctionOfItsKeys) {
  Rng a(1, 2, 3), b(1, 2, 3), c(1, 2, 4);
  int same = 0;
  for (int i = 0; i < 100; ++i) {
    const std::uint32_t value = a.nextUint();
    EXPECT_EQ(value, b.nextUint());
    same += value == c.nextUint();
  }
  EXPECT_EQ(same, 0);
  EXPECT_EQ(pcgHash(0), 129708002u);  // the published hash's first value
}

TEST(Rng, IsEvenWithinAndAcrossStreams) {
  const int total = 64000;
  std::vector<int> within(64), across(64), pairs(64), low(64);
  Rng random(7);
  for (int i = 0; i < total; ++i) {
    const float u = random.next();
    ASSERT_TRUE(u >= 0.0f && u < 1.0f);
    ++within[static_cast<std::size_t>(u * 64.0f)];
    Rng other(7, static_cast<std::uint32_t>(i));
    const glm::vec2 p = other.next2();
    ++across[static_cast<std::size_t>(p.x * 64.0f)];
    ++pairs[static_cast<std::size_t>(p.x * 8.0f) * 8 + static_cast<std::size_t>(p.y * 8.0f)];
    ++low[pcgHash(static_cast<std::uint32_t>(i)) & 63u];
  }
  for (const auto& histogram : {within, across, pairs, low})
    EXPECT_LT(std::abs(chiSquareDeviations(histogram, total)), 5.0);
  std::vector<int> dice(7);
  for (int i = 0; i < 7000; ++i) ++dice[random.below(7)];
  EXPECT_LT(std::abs(chiSquareDeviations(dice, 7000)), 5.0);
  EXPECT_LT(toUnitFloat(0xffffffffu), 1.0f);
}

TEST(Sequences, RadicalInverseMirrorsDigits) {
  EXPECT_EQ(radicalInverse(2, 1), 0.5f);
  EXPECT_EQ(radicalInverse(2, 6), 0.375f);
  EXPECT_FLOAT_EQ(radicalInverse(3, 5), 7.0f / 9.0f);
  EXPECT_LT(radicalInverse(2, ~std::uint64_t{0}), 1.0f);
}

/// Every elementary interval of area 1/64 holds one of 64 points.
void expectNet(const std::function<glm::vec2(std::uint32_t)>& point, std::uint32_t first) {
  for (int split = 0; split <= 6; ++split) {
    std::set<std::pair<int, int>> cells;
    for (std::uint32_t i = first; i < first + 64; ++i) {
      const glm::vec2 p = point(i);
      cells.emplace(static_cast<int>(p.x * static_cast<float>(1 << split)),
                    static_cast<int>(p.y * static_cast<float>(64 >> split)));
    }
    EXPECT_EQ(cells.size(), 64u) << split;
  }
}

TEST(Sequences, SobolIsANetAlsoWhenScrambled) {
  for (const std::uint32_t first : {0u, 64u, 640u, 65536u}) {
    expectNet([](std::uint32_t i) { return sobol2(i); }, first);
    for (const std::uint32_t seed : {0u, 1u, 77u})
      expectNet([seed](std::uint32_t i) { return sobol2(i, seed); }, first);
  }
  EXPECT_NE(sobol2(5, 1), sobol2(5, 2));
}

TEST(Sequences, ScramblingHasNoBias) {
  std::vector<int> histogram(64);
  for (std::uint32_t seed = 0; seed < 16000; ++seed) {
    const glm::vec2 p = sobol2(3, seed);
    ++histogram[static_cast<std::size_t>(p.x * 8.0f) * 8 + static_cast<std::size_t>(p.y * 8.0f)];
  }
  EXPECT_LT(chiSquareDeviations(histogram, 16000), 5.0);
}

TEST(Sequences, R2IsEven) {
  std::vector<int> histogram(64);
  for (std::uint32_t i = 0; i < 6400; ++i) {
    const glm::vec2 p = r2(i);
    ++histogram[static_cast<std::size_t>(p.x * 8.0f) * 8 + static_cast<std::size_t>(p.y * 8.0f)];
  }
  for (const int count : histogram) EXPECT_NEAR(count, 100, 4);
}

/// Cells of equal probability, told by the warp's inverse distribution: cos(theta) to [0, 1), and the azimuth.
void expectDensity(const std::function<glm::vec3(const glm::vec2&)>& warp,
                   const std::function<double(double)>& cumulative_of_z) {
  const int total = 40000;
  std::vector<int> histogram(100);
  Rng random(11);
  for (int i = 0; i < total; ++i) {
    const glm::vec3 d = warp(random.next2());
    EXPECT_NEAR(glm::length(d), 1.0f, 1e-5f);
    const double share = std::clamp(cumulative_of_z(double(d.z)), 0.0, 0.999999);
    const double turn =
        std::clamp(std::atan2(double(d.y), double(d.x)) / (2.0 * 3.14159265358979) + 0.5, 0.0, 0.999999);
    ++histogram[static_cast<std::size_t>(share * 10.0) * 10 + static_cast<std::size_t>(turn * 10.0)];
  }
  EXPECT_LT(std::abs(chiSquareDeviations(histogram, total)), 5.0);
}

TEST(Warps, HaveTheDensitiesTheyPromise) {
  expectDensity([](const glm::vec2& u) { return uniformSphere(u); },
                [](double z) { return 0.5 * (1.0 - z); });
  expectDensity([](const glm::vec2& u) { return uniformHemisphere(u); }, [](double z) { return 1.0 - z; });
  expectDensity([](const glm::vec2& u) { return cosineHemisphere(u); }, [](double z) { return 1.0 - z * z; });
  for (const float n : {1.0f, 20.0f, 3000.0f})
    expectDensity([n](const glm::vec2& u) { return phongLobe(u, n); },
                  [n](double z) { return 1.0 - std::pow(z, double(n) + 1.0); });
  expectDensity([](const glm::vec2& u) { return uniformCone(u, 0.9f); },
                [](double z) { return (1.0 - z) / 0.1; });
}

TEST(Warps, NarrowLobesKeepTheirWidth) {
  // Mean of 1 - z is 1 / (n + 2); floats near 1 could not tell it from z alone, so it is read from the radius.
  double sum = 0.0;
  Rng random(3);
  const int total = 20000;
  for (int i = 0; i < total; ++i) {
    const glm::vec3 d = phongLobe(random.next2(), 1.0e6f);
    sum += 0.5 * (double(d.x) * double(d.x) + double(d.y) * double(d.y));
  }
  EXPECT_NEAR(sum / total * 1.0e6, 1.0, 0.03);
}

TEST(Warps, DiscAndTriangleAreEven) {
  std::vector<int> disc(64), triangle(64);
  Rng random(13);
  const int total = 32000;
  for (int i = 0; i < total; ++i) {
    const glm::vec2 p = uniformDisc(random.next2());
    const double share = std::min(0.999999, double(glm::dot(p, p)));
    const double turn = std::clamp(std::atan2(double(p.y), double(p.x)) / 6.28318530718 + 0.5, 0.0, 0.999999);
    ++disc[static_cast<std::size_t>(share * 8.0) * 8 + static_cast<std::size_t>(turn * 8.0)];
    const glm::vec3 b = uniformTriangle(random.next2());
    ASSERT_TRUE(b.x >= 0.0f && b.y >= 0.0f && b.z >= 0.0f);
    EXPECT_NEAR(b.x + b.y + b.z, 1.0f, 1e-6f);
    // (1 - b.x)^2 and b.y / (1 - b.x) are uniform in a triangle.
    const double first = std::min(0.999999, (1.0 - double(b.x)) * (1.0 - double(b.x)));
    const double second = std::min(0.999999, double(b.y) / std::max(1e-12, 1.0 - double(b.x)));
    ++triangle[static_cast<std::size_t>(first * 8.0) * 8 + static_cast<std::size_t>(second * 8.0)];
  }
  EXPECT_LT(std::abs(chiSquareDeviations(disc, total)), 5.0);
  EXPECT_LT(std::abs(chiSquareDeviations(triangle, total)), 5.0);
}

TEST(Warps, FramesAreOrthonormalAndRightHanded) {
  for (glm::vec3 n : fibonacciSphere(500)) {
    const glm::mat3 m = frame(n);
    EXPECT_NEAR(glm::determinant(m), 1.0f, 1e-6f);
    EXPECT_NEAR(glm::dot(m[0], m[1]), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::dot(m[0], n), 0.0f, 1e-6f);
    EXPECT_EQ(m[2], n);
  }
  for (const float z : {1.0f, -1.0f}) EXPECT_NEAR(glm::determinant(frame({0, 0, z})), 1.0f, 1e-6f);
}

TEST(Directions, StratifiedCoversEveryCell) {
  const std::vector<glm::vec3> directions = stratifiedSphere(6, 2);
  ASSERT_EQ(directions.size(), 72u);
  glm::vec3 sum(0.0f);
  for (const glm::vec3& d : directions) sum += d;
  EXPECT_LT(glm::length(sum), 3.0f);
  EXPECT_THROW(stratifiedSphere(0, 1), Error);
}

/// Root-mean-square error, over many caps, of the share of a set's first directions that lie in a cap.
double capError(const TiledDirections& set, int tiles, float cosine) {
  double squares = 0.0;
  const int caps = 100;
  for (int c = 0; c < caps; ++c) {
    const glm::vec3 axis = fibonacciDirection(static_cast<std::uint32_t>(c), caps);
    int inside = 0;
    for (int i = 0; i < tiles * 16; ++i) inside += glm::dot(axis, set.direction(i)) > cosine;
    const double error = double(inside) / (tiles * 16) - 0.5 * (1.0 - double(cosine));
    squares += error * error;
  }
  return std::sqrt(squares / caps);
}

/// The same of the mean of max(0, cos), relative.
double cosineError(const TiledDirections& set, int tiles) {
  double squares = 0.0;
  for (int c = 0; c < 100; ++c) {
    const glm::vec3 axis = fibonacciDirection(static_cast<std::uint32_t>(c), 100);
    double sum = 0.0;
    for (int i = 0; i < tiles * 16; ++i) sum += std::max(0.0, double(glm::dot(axis, set.direction(i))));
    squares += (4.0 * sum / (tiles * 16) - 1.0) * (4.0 * sum / (tiles * 16) - 1.0);
  }
  return std::sqrt(squares / 100.0);
}

TEST(TiledDirections, ConesHoldTheirTilesAndTilesAreCompact) {
  for (const int levels : {1, 3}) {
    const TiledDirections set = makeTiledDirections(10000, levels);
    ASSERT_EQ(set.count(), 10000);
    ASSERT_EQ(set.even_prefixes.size(), static_cast<std::size_t>(levels));
    EXPECT_EQ(set.even_prefixes.back(), set.tiles());
    double solid_angle = 0.0;
    for (int t = 0; t < set.tiles(); ++t) {
      const auto& cone = set.cones[static_cast<std::size_t>(t)];
      for (int i = 16 * t; i < 16 * t + 16; ++i) {
        EXPECT_NEAR(glm::length(set.direction(i)), 1.0f, 1e-6f);
        EXPECT_GE(glm::dot(set.direction(i), cone.axis), cone.cos_half_angle);
      }
      solid_angle += 2.0 * 3.14159265 * (1.0 - double(cone.cos_half_angle));
    }
    // Discs that hold 16 neighbours of an even set cover the sphere less than twice, level by level.
    EXPECT_LT(solid_angle / (4.0 * 3.14159265), levels == 1 ? 2.0 : 6.0);
  }
}

TEST(TiledDirections, EveryDirectionIsThereOnce) {
  const TiledDirections set = makeTiledDirections(4096);
  std::set<std::tuple<float, float, float>> seen;
  for (int i = 0; i < set.count(); ++i)
    seen.emplace(set.direction(i).x, set.direction(i).y, set.direction(i).z);
  EXPECT_EQ(seen.size(), 4096u);
}

TEST(TiledDirections, AnyPrefixIsEven) {
  const TiledDirections one = makeTiledDirections(16384, 1), three = makeTiledDirections(16384, 3, 5);
  for (const auto* set : {&one, &three}) {
    for (const int tiles : {100, 200, 300, 500, 777, 1000}) {
      const double random = std::sqrt(0.35 * 0.65 / (tiles * 16.0));
      EXPECT_LT(capError(*set, tiles, 0.3f), 1.4 * random) << tiles;
      EXPECT_LT(cosineError(*set, tiles), 2.0 / tiles) << tiles;
    }
    EXPECT_LT(capError(*set, 1024, 0.3f), 6e-4);
    EXPECT_LT(cosineError(*set, 1024), 3e-5);
  }
  EXPECT_LT(cosineError(three, three.even_prefixes[0]), 1e-4);
  EXPECT_LT(capError(three, three.even_prefixes[1], 0.3f), 1e-3);
}

TEST(TiledDirections, SizesAtTheEdge) {
  EXPECT_EQ(makeTiledDirections(1).count(), 16);
  EXPECT_EQ(makeTiledDirections(17).tiles(), 2);
  EXPECT_EQ(makeTiledDirections(40, 8).tiles(), 3);
  EXPECT_THROW(makeTiledDirections(0), Error);
  EXPECT_THROW(makeTiledDirections((1 << 24) + 1), Error);
  EXPECT_THROW(makeTiledDirections(100, 0), Error);
  EXPECT_NEAR(TiledDirections::solidAngle(64) * 1024.0f, 12.566371f, 1e-5f);
  EXPECT_THROW(fibonacciSphere(0), Error);
}

TEST(TiledDirections, SeedsTurnTheSet) {
  const TiledDirections a = makeTiledDirections(256, 1, 1), b = makeTiledDirections(256, 1, 2),
                        c = makeTiledDirections(256, 1, 1);
  EXPECT_EQ(a.x, c.x);
  EXPECT_NE(a.x, b.x);
}

}  // namespace
}  // namespace gloam::sampling
