// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference/sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "reference/angles.h"
#include "reference/distribution.h"
#include "reference/lanes.h"

namespace gloam::reference {
namespace {

// Any aligned block of 2^k points has one point in each of the 2^k boxes of every shape.
TEST(Sampler, EveryPairIsANetInEveryAlignedBlock) {
  for (const std::uint32_t pair : {0u, 1u, 2u, 7u, 40u}) {
    for (const std::uint32_t first : {0u, 64u, 4096u + 192u}) {
      for (int a = 0; a <= 6; ++a) {
        std::set<std::uint32_t> boxes;
        for (std::uint32_t i = first; i < first + 64; ++i) {
          const glm::uvec2 b = Sampler(3, 11, i).numbers(pair);
          const std::uint32_t column = a == 0 ? 0 : b.x >> (32 - a), row = a == 6 ? 0 : b.y >> (26 + a);
          boxes.insert(column << 16 | row);
        }
        EXPECT_EQ(boxes.size(), 64u) << "pair " << pair << ", from " << first << ", " << a << " bits of x";
      }
    }
  }
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - 0.5) * (b[i] - 0.5);
  return sum * 12.0 / double(a.size());
}

// 20,000 numbers: the correlation of independent ones has a standard deviation of 0.007.
TEST(Sampler, PixelsPairsSamplesAndSeedsKnowNothingOfEachOther) {
  constexpr std::uint32_t kCount = 20000;
  const auto column = [](auto number) {
    std::vector<double> numbers;
    for (std::uint32_t i = 0; i < kCount; ++i) numbers.push_back(number(i));
    return numbers;
  };
  const auto at = [](std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample, std::uint32_t pair) {
    return double(Sampler(seed, pixel, sample).pair(pair).x);
  };
  const auto base = column([&](std::uint32_t i) { return at(1, i, 0, 0); });
  double mean = 0.0;
  for (const double x : base) mean += x / kCount;
  EXPECT_NEAR(mean, 0.5, 4 * 0.002);
  const std::vector<std::vector<double>> others = {
      column([&](std::uint32_t i) { return at(1, i + 1, 0, 0); }),
      column([&](std::uint32_t i) { return at(1, i + 1024, 0, 0); }),
      column([&](std::uint32_t i) { return at(1, i, 0, 1); }),
      column([&](std::uint32_t i) { return at(2, i, 0, 0); }),
      column([&](std::uint32_t i) { return at(1ull << 40, i, 0, 0); }),
      column([&](std::uint32_t i) { return double(Sampler(1, i, 0).pair(0).y); }),
      column([&](std::uint32_t i) { return double(Sampler(1, i, 5).pair(3).y); }),
  };
  for (std::size_t k = 0; k < others.size(); ++k)
    EXPECT_LT(std::abs(correlation(base, others[k])), 0.03) << k;
}

TEST(Sampler, FollowsFromItsArguments) {
  EXPECT_EQ(Sampler(5, 6, 7).numbers(8), Sampler(5, 6, 7).numbers(8));
  EXPECT_NE(Sampler(5, 6, 7).numbers(8), Sampler(6, 6, 7).numbers(8));
  EXPECT_LT(Sampler::toUnit(0xffffffffu), 1.0f);
}

TEST(Lanes, NumbersAreThoseOfOneSample) {
  LaneBits places, x, y;
  for (std::uint32_t i = 0; i < std::uint32_t(kLanes); ++i) places.at[i] = Sampler(3, 4, 77 * i).place();
  numbersOfLanes(Sampler(3, 4, 0).scramble(9), places, x, y);
  for (int i = 0; i < kLanes; ++i)
    EXPECT_EQ(glm::uvec2(x.at[i], y.at[i]), Sampler(3, 4, 77u * std::uint32_t(i)).numbers(9));
}

TEST(Angles, AreThoseOfTheMathematicsLibrary) {
  constexpr double kTurn = 2.0 * 3.14159265358979323846;
  for (int i = -1000; i <= 1000; ++i) {
    const float turns = float(i) / 1000.0f;
    const angles::Circle circle = angles::circle(turns);
    EXPECT_NEAR(circle.cosine, std::cos(kTurn * double(turns)), 5e-7);
    EXPECT_NEAR(circle.sine, std::sin(kTurn * double(turns)), 5e-7);
    const float x = circle.cosine * 3.0f, y = circle.sine * 3.0f;
    EXPECT_NEAR(angles::turns(y, x), std::atan2(double(y), double(x)) / kTurn, 1e-7);
  }
  EXPECT_EQ(angles::turns(0.0f, 0.0f), 0.0f);
  EXPECT_EQ(angles::turns(0.0f, -2.0f), 0.5f);
}

TEST(Distribution, ChoosesWithTheProbabilityItTells) {
  const std::vector<float> weights = {0.0f, 3.0f, 0.0f, 1e-3f, 5.0f, 2.0f, 0.0f};
  const Distribution choice(weights);
  double total = 0.0;
  for (std::uint32_t i = 0; i < weights.size(); ++i) total += double(choice.probability(i));
  EXPECT_NEAR(total, 1.0, 1e-6);
  std::vector<double> counts(weights.size());
  constexpr std::uint32_t kCount = 1u << 16;
  std::uint32_t before = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const Distribution::Choice chosen = choice.choose(i << 16 | 0x8000u);
    counts[chosen.index] += 1.0 / kCount;
    EXPECT_GE(chosen.rest, 0.0f);
    EXPECT_LE(chosen.rest, 1.0f);
    EXPECT_GE(chosen.index, before);  // larger numbers, later entries
    before = chosen.index;
  }
  for (std::uint32_t i = 0; i < weights.size(); ++i) {
    EXPECT_NEAR(counts[i], double(choice.probability(i)), 2.0 / kCount);
    EXPECT_NEAR(choice.probability(i), weights[i] / 10.001f, 1e-6f);
  }
  EXPECT_EQ(choice.choose(0u).index, 1u);
  EXPECT_EQ(choice.choose(0xffffffffu).index, 5u);
}

TEST(Distribution, NothingToChooseFrom) {
  EXPECT_TRUE(Distribution().empty());
  EXPECT_TRUE(Distribution(std::vector<float>{}).empty());
  EXPECT_TRUE(Distribution(std::vector<float>{0.0f, -1.0f, NAN}).empty());
  const Distribution one(std::vector<float>{2.0f});
  EXPECT_EQ(one.choose(0x12345678u).index, 0u);
  EXPECT_EQ(one.probability(0), 1.0f);
}

}  // namespace
}  // namespace gloam::reference
