// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "math/sampling.h"
#include "math/sh_constants.h"
#include "math/sh_exp_errors.h"
#include "math/sh_exp_fit.h"
#include "math/simd_test_targets.h"

namespace gloam::sh {
namespace {

constexpr ExpMethod kMethods[] = {ExpMethod::kSeries, ExpMethod::kLinear, ExpMethod::kHybrid,
                                  ExpMethod::kQuadratic};

/// Root mean square over the sphere of the difference.
double rms(const Sh& got, const Sh& want) {
  double sum = 0.0;
  for (int i = 0; i < want.size(); ++i) sum += std::pow(double(got[i]) - want[i], 2);
  return std::sqrt(sum) / kShZonal0;
}

/// Logs of both arrangements with 1 to 40 spheres.
std::vector<Sh> someLogs(int order) {
  std::vector<Sh> logs;
  const LogBlockerTable table = makeLogBlockerTable(order, 64);
  for (const Arrangement arrangement : {Arrangement::kScattered, Arrangement::kBody})
    for (const int blockers : {1, 6, 40})
      for (const auto& set : randomBlockers(arrangement, blockers, 4, 5))
        logs.push_back(sumOfLogs(table, set));
  return logs;
}

TEST(ShExp, OfNothingIsOne) {
  for (int order = 1; order <= kMaxOrder; ++order)
    for (const ExpMethod method : kMethods) {
      const Sh one = exponential(Sh(order), method);
      EXPECT_NEAR(one[0], kShZonal0, 1e-6f);
      for (int i = 1; i < one.size(); ++i) EXPECT_EQ(one[i], 0.0f);
    }
}

TEST(ShExp, ConstantsScaleTheResult) {
  for (int order = 1; order <= kMaxOrder; ++order)
    for (const Sh& f : someLogs(std::max(order, 2)))
      for (const float shift : {-3.0f, -0.1f, 2.0f})
        for (const ExpMethod method : kMethods) {
          const Sh low = truncated(f, order);
          Sh shifted = low, want = exponential(low, method);
          if (!std::isfinite(want[0]) || std::abs(want[0]) > 1e3f) continue;  // series far out
          shifted[0] += shift * kShZonal0;
          want *= std::exp(shift);
          EXPECT_LT(rms(exponential(shifted, method), want), 1e-4 * (rms(want, Sh(order)) + 1e-3));
        }
}

TEST(ShExp, TurnsWithItsFunction) {
  sampling::Rng random(4);
  const glm::mat3 turn = sampling::frame(sampling::uniformSphere(random.next2()));
  for (int order = 2; order <= kMaxOrder; ++order)
    for (const Sh& f : someLogs(order))
      for (const ExpMethod method : {ExpMethod::kLinear, ExpMethod::kHybrid, ExpMethod::kQuadratic})
        EXPECT_LT(rms(exponential(rotate(turn, f), method), rotate(turn, exponential(f, method))), 2e-5);
}

TEST(ShExp, NumericIsTheLimitOfTheSeries) {
  sampling::Rng random(5);
  for (int order = 2; order <= kMaxOrder; ++order) {
    Sh f(order);
    for (int i = 0; i < f.size(); ++i) f[i] = random.next() - 0.5f;
    EXPECT_LT(rms(expSeries(f, 30), expNumeric(f)), 1e-5);
    EXPECT_GT(rms(expSeries(f, 1), expNumeric(f)), rms(expSeries(f, 2), expNumeric(f)));
  }
}

TEST(ShExp, NumericIsThePointwiseExponentialOfSmoothFunctions) {
  sampling::Rng random(6);
  Sh f(6);
  for (int i = 0; i < 4; ++i) f[i] = random.next() - 0.5f;
  const Sh want = project(6, [&](const glm::vec3& d) { return std::exp(valueAt(f, d)); });
  EXPECT_LT(rms(expNumeric(f), want), 1e-5);
  EXPECT_LT(rms(SphereGrid(16).projectExponential(f), want), 1e-5);
}

TEST(ShExp, HybridAddsLittleToWhatTruncationCosts) {
  for (int order = 3; order <= kMaxOrder; ++order) {
    const std::vector<ExpErrorRow> rows = expErrors(order, {1, 4, 16, 40}, order < 5 ? 12 : 6);
    ASSERT_EQ(rows.size(), 8u);
    for (const ExpErrorRow& row : rows) {
      SCOPED_TRACE(fmt::format("order {}, {} {}", order, row.blockers, arrangementName(row.arrangement)));
      EXPECT_LT(row.visible_hybrid, 1.15 * row.visible_numeric + 0.006);
      EXPECT_LT(row.visible_quadratic, 1.15 * row.visible_numeric + 0.004);
      EXPECT_LT(row.hybrid, 0.06);
      EXPECT_LT(row.quadratic, 0.06);
      // The paper's order: linear is coarser, and series diverge where many spheres block.
      if (row.norm > 1.0) {
        EXPECT_GT(row.linear, row.hybrid);
      }
      if (row.norm > 5.0) {
        EXPECT_GT(row.series4, 3.0 * row.hybrid);
      }
      EXPECT_LT(row.visible_numeric, 0.2);
    }
  }
}

TEST(ShExp, OneBlockerIsWhatItsLogCameFrom) {
  for (int order = 3; order <= kMaxOrder; ++order)
    for (const float half_angle : {0.1f, 0.3f, 0.6f}) {
      const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, 3));
      const Sh log = rotateZonal(logBlocker(order, half_angle), axis);
      const Sh want = productOfVisibilities(order, {{axis, half_angle}});
      EXPECT_LT(rms(expHybrid(log), want), 0.02);
      EXPECT_LT(rms(expQuadratic(log), want), 0.02);
      EXPECT_GT(rms(Sh(order), want), 0.5);
    }
}

// The quadratic one not at all: what is left is the step itself, 0.02 % of the norm.
TEST(ShExp, HardlyJumpsWhereSquaringsChange) {
  for (int order = 3; order <= kMaxOrder; ++order) {
    double hybrid = 0.0, quadratic = 0.0;
    for (Sh f : someLogs(order)) {
      const float norm = std::sqrt(dot(f, f) - f[0] * f[0]);
      for (const float at : {0.25f, 0.5f, 1.0f, 2.0f, 4.0f, 8.0f}) {
        // Sums of logs only as strong as these sets have them: a half or more of their norm.
        if (at > norm || at < 0.5f * norm) continue;
        Sh below = f, above = f;
        below *= at / norm * 0.9999f;
        above *= at / norm * 1.0001f;
        hybrid = std::max(hybrid, rms(expHybrid(below), expHybrid(above)));
        quadratic = std::max(quadratic, rms(expQuadratic(below), expQuadratic(above)));
      }
    }
    RecordProperty(fmt::format("hybrid_jump_{}", order), fmt::format("{:.4f}", hybrid));
    RecordProperty(fmt::format("quadratic_jump_{}", order), fmt::format("{:.4f}", quadratic));
    EXPECT_LT(hybrid, 0.03) << order;
    EXPECT_LT(quadratic, 0.001) << order;
  }
}

TEST(ShExp, StaysFiniteBehindThousandsOfSpheres) {
  for (int order = 3; order <= kMaxOrder; ++order) {
    Sh f = rotateZonal(logBlocker(order, 0.8f), {0, 1, 0});
    for (int i = 0; i < 16; ++i, f *= 2.0f)
      for (const ExpMethod method : {ExpMethod::kHybrid, ExpMethod::kQuadratic}) {
        const Sh h = exponential(f, method);
        for (int c = 0; c < h.size(); ++c) ASSERT_TRUE(std::isfinite(h[c])) << order << ' ' << i;
        EXPECT_LT(std::abs(h[0]), 30.0f * kShZonal0);  // order 3: its log has bright lobes
      }
    f[1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isnan(expHybrid(f)[1]));  // comes back, as it is
  }
}

TEST(ShExp, TablesAreWhatTheFitFinds) {
  // The fit ends where it is flat: functions are compared, not coefficients.
  for (const bool quadratic : {false, true}) {
    const ExpCore have = quadratic ? quadraticCore(3) : hybridCore(3);
    const ExpCore want = fitExpCore(3, quadratic, have.range);
    for (float x = 0.1f; x <= 1.0f; x += 0.1f) {
      EXPECT_NEAR(have.a(x * have.range), want.a(x * have.range), 2e-3f);
      EXPECT_NEAR(have.b(x * have.range), want.b(x * have.range), 2e-3f);
      EXPECT_NEAR(have.c(x * have.range), want.c(x * have.range), 1e-2f);
    }
  }
  const ExpLinearTable linear = fitExpLinear(3, kShExpLinearEntries, kShExpLinearStep);
  for (std::size_t i = 0; i < linear.a.size(); ++i) {
    EXPECT_NEAR(kShExpLinearA3[i], linear.a[i], 1e-3);
    EXPECT_NEAR(kShExpLinearB3[i], linear.b[i], 1e-3);
  }
}

TEST(ShExp, ManyEqualOneOnEveryInstructionSet) {
  using Many = void (*)(int, std::size_t, std::span<const float>, std::span<float>, std::size_t);
  using One = Sh (*)(const Sh&);
  const std::pair<Many, One> pairs[] = {{expHybridMany, expHybrid}, {expQuadraticMany, expQuadratic}};
  for (int order = 1; order <= kMaxOrder; ++order) {
    std::vector<Sh> functions;
    for (const Sh& f : someLogs(std::max(order, 2))) functions.push_back(truncated(f, order));
    functions.emplace_back(order);
    const std::size_t count = functions.size(), stride = planeStride(count);
    const auto size = static_cast<std::size_t>(order * order);
    std::vector<float> planes(size * stride);
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t i = 0; i < size; ++i) planes[i * stride + k] = functions[k].c[i];
    onEveryTarget([&](const char* name) {
      SCOPED_TRACE(fmt::format("{}, order {}", name, order));
      for (const auto& [many, one] : pairs)
        for (const std::size_t part : {count, std::size_t{7}}) {
          std::vector<float> out(size * stride, -7.0f);
          many(order, part, planes, out, stride);
          EXPECT_EQ(out[part], -7.0f) << "written past the batch";
          for (std::size_t k = 0; k < part; ++k) {
            const Sh want = one(functions[k]);
            Sh got(order);
            for (std::size_t i = 0; i < size; ++i) got.c[i] = out[i * stride + k];
            EXPECT_LT(rms(got, want), 2e-5) << k;
          }
        }
    });
  }
}

TEST(ShExp, BadArgumentsAreErrors) {
  EXPECT_THROW(expHybrid(Sh()), Error);
  EXPECT_THROW(expQuadratic(Sh(7)), Error);
  EXPECT_THROW(expLinear(Sh()), Error);
  EXPECT_THROW(expSeries(Sh(3), 0), Error);
  std::vector<float> planes(100);
  EXPECT_THROW(expHybridMany(6, 4, planes, planes, 4), Error);
  EXPECT_THROW(expQuadraticMany(0, 4, planes, planes, 4), Error);
}

}  // namespace
}  // namespace gloam::sh
